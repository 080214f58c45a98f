//! What an id says of the specular light that is left out.

use assign_clustered::SpecularCut;
use serde_json::Value;

/// The cut of specular light that a segment says: `s0.001`, `cone45` or `dif`.
pub(super) fn specular_of(segment: &str) -> Option<SpecularCut> {
    let above_0 = |text: &str| text.parse().ok().filter(|number: &f32| *number > 0.0);
    if let Some(degrees) = segment.strip_prefix("cone") {
        return above_0(degrees).map(SpecularCut::ReflectedCone);
    }
    match segment {
        "dif" => Some(SpecularCut::WhereDiffuse),
        _ => above_0(segment.strip_prefix('s')?).map(SpecularCut::Below),
    }
}

/// The cut among a record's parameters: its name and its number.
pub(super) fn parameter(cut: SpecularCut) -> Option<(String, Value)> {
    let (name, value) = match cut {
        SpecularCut::None => return None,
        SpecularCut::Below(radiance) => ("specular_threshold", radiance.into()),
        SpecularCut::ReflectedCone(degrees) => ("lobe_degrees", degrees.into()),
        SpecularCut::WhereDiffuse => ("specular_where_diffuse", true.into()),
    };
    Some((name.to_owned(), value))
}
