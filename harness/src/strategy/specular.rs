//! The segment that says which specular light of area lights is left out.

use assign_clustered::SpecularCut;

/// Reads `s0.001`, `cone45` or `dif`.
pub(super) fn parse(segment: &str) -> Option<SpecularCut> {
    let above_0 = |text: &str| text.parse().ok().filter(|number: &f32| *number > 0.0);
    if let Some(degrees) = segment.strip_prefix("cone") {
        return above_0(degrees).map(SpecularCut::ReflectedCone);
    }
    match segment {
        "dif" => Some(SpecularCut::WhereDiffuse),
        _ => above_0(segment.strip_prefix('s')?).map(SpecularCut::Below),
    }
}

/// The segment of a cut; `None` where no specular light is left out.
pub(super) fn segment(cut: SpecularCut) -> Option<String> {
    match cut {
        SpecularCut::None => None,
        SpecularCut::Below(radiance) => Some(format!("s{radiance}")),
        SpecularCut::ReflectedCone(degrees) => Some(format!("cone{degrees}")),
        SpecularCut::WhereDiffuse => Some("dif".to_owned()),
    }
}
