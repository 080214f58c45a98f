//! The options of what is drawn over the opaque surfaces.

use clap::{Args, FromArgMatches};
use scenes::{
    MAX_PARTICLES,
    stability::{self, PREFIX},
};

use super::{headings::LAYERS, values};

/// Transparent surfaces, particles and fog. A strategy that serves only opaque surfaces refuses them.
#[derive(Args, Clone, Debug, Default, PartialEq)]
pub struct LayerArgs {
    /// Blend the scene's transparent surfaces (alphaMode BLEND, KHR_materials_transmission)
    #[arg(long, help_heading = LAYERS, hide_short_help = true)]
    pub transparent: bool,

    /// Scatter N particles in the scene, lit per fragment; 0 to 1,048,576
    #[arg(long, value_name = "N", default_value = "0", allow_hyphen_values = true, value_parser = values::whole_from(0, MAX_PARTICLES), help_heading = LAYERS, hide_short_help = true)]
    pub particles: u32,

    /// Fill the view with fog that scatters light at the rate X per metre; 1e-6 to 1e3
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = values::number_from(1e-6, 1e3), help_heading = LAYERS, hide_short_help = true)]
    pub fog: Option<f64>,
}

impl LayerArgs {
    /// Adds the layers without which a scenario does not show its situation. Options that are given stay.
    pub(super) fn add_those_of(&mut self, scene: &str) {
        let Some(those) = layers_of(scene) else { return };
        self.transparent |= those.transparent;
        self.fog = self.fog.or(those.fog);
        if self.particles == 0 {
            self.particles = those.particles;
        }
    }
}

/// The layers of a scenario; `None` for other scenes.
fn layers_of(scene: &str) -> Option<LayerArgs> {
    let name = scene.strip_prefix(PREFIX)?.split(':').next()?;
    let options = stability::named(name)?.options;
    let command = LayerArgs::augment_args(clap::Command::new("scenario"));
    // Its other options are no layers.
    let command = command.no_binary_name(true).ignore_errors(true);
    LayerArgs::from_arg_matches(&command.try_get_matches_from(options).ok()?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Invocation, parse};

    fn layers(line: &str) -> LayerArgs {
        match parse(line.split(' ')) {
            Ok(Invocation::Compare(args)) => args.layers,
            Ok(Invocation::Explain(args)) => args.layers,
            other => panic!("{line}: {other:?}"),
        }
    }

    #[test]
    fn scenarios_bring_their_layers_and_options_that_are_given_stay() {
        for scenario in stability::list() {
            let of_scenario = layers_of(&scenario.id());
            assert!(of_scenario.is_some(), "{}: {:?}", scenario.name, scenario.options);
            let is_plain = of_scenario == Some(LayerArgs::default());
            let is_layer =
                |option: &&str| ["--transparent", "--particles", "--fog"].contains(option);
            assert_eq!(is_plain, !scenario.options.iter().any(is_layer), "{}", scenario.name);
        }
        let fog = layers("lightbench --scene stability:fog").fog;
        assert!(fog.is_some());
        assert_eq!(layers("lightbench explain --scene stability:fog --pixel 1,1").fog, fog);
        assert_eq!(layers("lightbench --scene stability:fog --fog 0.5").fog, Some(0.5));
        assert_eq!(layers("lightbench --scene atrium"), LayerArgs::default());
    }
}
