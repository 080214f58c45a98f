//! Escapes control characters in the text of results.

use crate::visible::visible;

use super::Results;

impl Results {
    /// Escapes control characters in all text that reports show. The command keeps them, because it can be run
    /// again.
    pub(super) fn show_hidden(&mut self) {
        let machine = &mut self.machine;
        let mut all: Vec<&mut String> = vec![
            &mut machine.adapter,
            &mut machine.driver,
            &mut machine.backend,
            &mut machine.cpu,
            &mut machine.os,
            &mut machine.commit,
            &mut machine.date,
        ];
        all.extend(&mut machine.rustc);
        all.extend(&mut self.truth.notes);
        all.extend(&mut self.warnings);
        all.extend(self.rejected_lights.iter_mut().flat_map(|l| [&mut l.scene, &mut l.reason]));
        all.extend(self.refused.iter_mut().flat_map(|r| [&mut r.strategy, &mut r.reason]));
        all.extend(self.truth_image.iter_mut().map(|image| &mut image.scene));
        if let Some(run) = &mut self.deep_images {
            all.extend([&mut run.scene, &mut run.deep.build, &mut run.deep.spread]);
        }
        for record in &mut self.records {
            record.strategy.show_hidden();
            all.extend([&mut record.setting.scene, &mut record.setting.scene_hash]);
            let known = [
                &mut record.setting.path_hash,
                &mut record.setting.area_model,
                &mut record.setting.radii,
                &mut record.setting.light_places,
                &mut record.setting.cut,
                &mut record.setting.light_order,
                &mut record.note,
            ];
            all.extend(known.into_iter().flatten());
            if let Some(shadows) = &mut record.setting.shadows {
                all.push(&mut shadows.model);
                let deep = shadows.deep.iter_mut();
                all.extend(deep.flat_map(|deep| [&mut deep.build, &mut deep.spread]));
            }
            let motion = record.setting.motion.iter_mut();
            all.extend(motion.flat_map(|motion| [&mut motion.law, &mut motion.moved_by]));
            if let Some(vpls) = &mut record.indirect {
                all.push(&mut vpls.ranges);
                let deep = vpls.deep.iter_mut();
                all.extend(deep.flat_map(|deep| [&mut deep.build, &mut deep.spread]));
            }
        }
        for text in all {
            if let std::borrow::Cow::Owned(shown) = visible(text) {
                *text = shown;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_in_names_are_escaped() {
        let mut results: Results = serde_json::from_str(include_str!("example.json")).unwrap();
        let odd = || "a\u{1b}[2J\nreport   /elsewhere".to_owned();
        results.machine.adapter = odd();
        results.records[0].setting.scene = odd();
        results.records[0].setting.radii = Some(odd());
        results.warnings.push(odd());
        results.command.push(odd());
        results.show_hidden();
        let shown = "a\\u{1b}[2J\\nreport   /elsewhere";
        let record = &results.records[0];
        let texts = [&results.machine.adapter, &record.setting.scene, &results.warnings[0]];
        assert!(texts.iter().all(|text| *text == shown), "{texts:?}");
        assert_eq!(record.setting.radii.as_deref(), Some(shown));
        assert_eq!(results.command.last(), Some(&odd()), "the command is to be run again");
    }
}
