//! Minimises a function of three variables without derivatives (Nelder and Mead 1965).

use glam::DVec3;

/// The most rounds.
const ROUNDS: usize = 200;

/// Walks from `start`, with first steps of `step` along each axis, to a minimum. It ends when the
/// values at the corners of the simplex differ by less than a share of `tolerance`.
pub(super) fn minimize(
    start: DVec3,
    step: f64,
    tolerance: f64,
    f: impl Fn(DVec3) -> f64,
) -> (DVec3, f64) {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let mut simplex = corners.map(|corner| {
        let point = start + step * corner;
        (point, f(point))
    });
    for _ in 0..ROUNDS {
        simplex.sort_by(|a, b| a.1.total_cmp(&b.1));
        let [best, second, third, worst] = simplex;
        if worst.1 - best.1 <= tolerance * best.1.abs() {
            break;
        }
        let middle = (best.0 + second.0 + third.0) / 3.0;
        let along = |factor: f64| {
            let point = middle + factor * (worst.0 - middle);
            (point, f(point))
        };
        let reflected = along(-1.0);
        let better = if reflected.1 < best.1 {
            let expanded = along(-2.0);
            if expanded.1 < reflected.1 { expanded } else { reflected }
        } else if reflected.1 < third.1 {
            reflected
        } else {
            along(if reflected.1 < worst.1 { -0.5 } else { 0.5 })
        };
        if better.1 < worst.1 {
            simplex[3] = better;
        } else {
            simplex = simplex.map(|(point, _)| {
                let point = best.0 + 0.5 * (point - best.0);
                (point, f(point))
            });
        }
    }
    simplex.into_iter().fold(simplex[0], |best, next| if next.1 < best.1 { next } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bottom_of_a_bent_valley_is_found() {
        // Rosenbrock's valley, raised, plus a separate third variable.
        let valley = |p: DVec3| {
            1.0 + (1.0 - p.x).powi(2) + 10.0 * (p.y - p.x * p.x).powi(2) + (p.z - 3.0).powi(2)
        };
        let (point, value) = minimize(DVec3::new(-1.0, 1.0, 0.0), 0.5, 1e-12, valley);
        assert!(point.distance(DVec3::new(1.0, 1.0, 3.0)) < 1e-4, "{point}: {value}");
    }
}
