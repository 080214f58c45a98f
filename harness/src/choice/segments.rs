//! Reads the segments of an id and rejects those that contradict each other.

use assign::{AreaBounds, FrustumTests, LightSource};
use assign_clustered::{Normals, SpecularCut};

use super::{ALL, Choice, specular::specular_of};
use crate::{
    cli::CliError,
    registry::{Axis, STRATEGIES, Spec, StrategyEntry},
};

/// The prefix of a segment that sets the bins of normals.
const NORMALS: &str = "n";
/// The prefix of a segment that sets the most lights of a list.
pub(super) const CAP: &str = "cap";
/// The prefix of a segment that sets for how many frames lists are used.
const REUSE: &str = "reuse";

impl Choice {
    /// Looks an id such as `SC-E/48x48x40/bvh` up; a family alone takes its default parameters.
    pub fn parse(id: &str) -> Result<Self, CliError> {
        let mut segments = id.split('/');
        let family = segments.next().unwrap_or_default();
        let same = |entry: &&StrategyEntry| entry.family.eq_ignore_ascii_case(family);
        let Some(entry) = STRATEGIES.iter().find(same) else {
            let mut known: Vec<&str> = STRATEGIES.iter().map(|entry| entry.family).collect();
            known.push(ALL);
            return Err(CliError::unknown("strategy", id, &known));
        };
        let mut choice = Self {
            entry,
            spec: Spec { parameters: entry.default.to_owned(), ..Spec::default() },
            says: (false, false),
            is_named: true,
            id: id.to_owned(),
        };
        // The segment that set the parameters.
        let mut parameters: Option<String> = None;
        // The axes set so far, each with the segment that set it.
        let mut set: Vec<(Axis, String)> = Vec::new();
        for segment in segments {
            let segment = segment.to_lowercase();
            match axis_of(&segment) {
                Some(axis) if !entry.axes.contains(&axis) => return Err(choice.refuse(&segment)),
                Some(axis) => {
                    if let Some((_, earlier)) = set.iter().find(|(known, _)| *known == axis) {
                        let reason = format!("only one segment may be {}", axis.accepted());
                        return Err(choice.refuse_pair(earlier, &segment, &reason));
                    }
                    choice.set(axis, &segment)?;
                    set.push((axis, segment));
                }
                None if entry.parameters.is_empty() || segment.is_empty() => {
                    return Err(choice.refuse(&segment));
                }
                None => match &parameters {
                    Some(earlier) if segment.starts_with(|c: char| c.is_ascii_digit()) => {
                        let what = entry.parameters.join(" x ");
                        let reason = format!("only one segment may be {what}");
                        return Err(choice.refuse_pair(earlier, &segment, &reason));
                    }
                    Some(_) => return Err(choice.refuse(&segment)),
                    None => {
                        choice.spec.parameters.clone_from(&segment);
                        parameters = Some(segment);
                    }
                },
            }
        }
        let normals = set.iter().find(|(axis, _)| *axis == Axis::Normals);
        if let Some((_, normals)) = normals
            && choice.spec.specular == SpecularCut::WhereDiffuse
        {
            let reason = "`dif` cannot be combined with normal cones";
            return Err(choice.refuse_pair("dif", normals, reason));
        }
        choice.check_bounds()?;
        Ok(choice)
    }

    /// Sets one axis from its segment.
    fn set(&mut self, axis: Axis, segment: &str) -> Result<(), CliError> {
        match axis {
            Axis::Tests => {
                self.spec.settings.tests = segment.parse().map_err(|_| self.refuse(segment))?;
                self.says.0 = true;
            }
            Axis::Source => {
                self.spec.settings.source = match segment {
                    "bvh" => LightSource::Hierarchy,
                    _ => LightSource::Linear,
                };
                self.says.1 = true;
            }
            Axis::AreaBounds => {
                self.spec.settings.area_bounds = match segment {
                    "ball" => AreaBounds::Ball,
                    _ => AreaBounds::Outline,
                };
            }
            Axis::Box => {
                self.spec.grid_box = segment.parse().map_err(|_| self.refuse(segment))?;
            }
            Axis::Normals => {
                let bins = number_of(segment, NORMALS).map(Normals::Bins);
                self.spec.normals = bins
                    .filter(|normals| normals.check().is_ok())
                    .ok_or_else(|| self.refuse(segment))?;
            }
            Axis::Specular => {
                self.spec.specular = specular_of(segment).ok_or_else(|| self.refuse(segment))?;
            }
            Axis::Cap => {
                let cap = number_of(segment, CAP).ok_or_else(|| self.refuse(segment))?;
                self.spec.cap = Some(cap);
            }
            Axis::Reuse => {
                let frames = number_of(segment, REUSE).ok_or_else(|| self.refuse(segment))?;
                self.spec.reuse = Some(frames);
            }
            Axis::Exit => self.spec.evaluates_all = true,
        }
        Ok(())
    }

    /// Rejects balls around area lights together with the hierarchy: its nodes are boxes around the
    /// lights' outlines, so lists would not be those of balls.
    pub(super) fn check_bounds(&self) -> Result<(), CliError> {
        let settings = &self.spec.settings;
        let has_source = self.entry.axes.contains(&Axis::Source);
        match (settings.area_bounds, settings.source) {
            (AreaBounds::Ball, LightSource::Hierarchy) if has_source => {
                let reason = "the hierarchy's nodes bound the lights' outlines, not their balls";
                Err(self.refuse_pair("ball", "bvh", reason))
            }
            _ => Ok(()),
        }
    }

    /// Two segments that cannot stand in one id.
    fn refuse_pair(&self, first: &str, second: &str, reason: &str) -> CliError {
        if first == second {
            let once = "it must be given once";
            return CliError::new(format!(
                "strategy {}: {first:?} is given twice: {once}",
                self.id
            ));
        }
        CliError::new(format!(
            "strategy {}: {first:?} and {second:?} contradict each other: {reason}",
            self.id
        ))
    }

    fn refuse(&self, segment: &str) -> CliError {
        let mut accepted: Vec<String> = Vec::new();
        if !self.entry.parameters.is_empty() {
            accepted.push(self.entry.parameters.join(" x "));
        }
        accepted.extend(self.entry.axes.iter().map(|axis| axis.accepted().to_owned()));
        let accepted = if accepted.is_empty() {
            "nothing after a slash".to_owned()
        } else {
            format!("segments that are {}", accepted.join(", or "))
        };
        CliError::new(format!(
            "strategy {}: {segment:?} is unknown: {} takes {accepted}",
            self.id, self.entry.family
        ))
    }
}

/// The number after a prefix, from 1.
fn number_of(segment: &str, prefix: &str) -> Option<u32> {
    segment.strip_prefix(prefix)?.parse().ok().filter(|number| *number > 0)
}

/// The axis that a segment sets; `None` where it can only be parameters.
fn axis_of(segment: &str) -> Option<Axis> {
    match segment {
        "linear" | "bvh" => Some(Axis::Source),
        "positions" | "supports" | "lights" | "surfaces" => Some(Axis::Box),
        "ball" | "outline" => Some(Axis::AreaBounds),
        _ if segment.starts_with(CAP) => Some(Axis::Cap),
        _ if number_of(segment, NORMALS).is_some() => Some(Axis::Normals),
        "no-exit" => Some(Axis::Exit),
        _ if specular_of(segment).is_some() => Some(Axis::Specular),
        _ if segment.starts_with(REUSE) => Some(Axis::Reuse),
        _ => segment.parse::<FrustumTests>().ok().map(|_| Axis::Tests),
    }
}
