//! Straight lines through points, by least squares.

/// A line through points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fit {
    /// Growth of `y` per unit of `x`.
    pub(crate) slope: f64,
    /// `y` at `x = 0`.
    pub(crate) offset: f64,
    /// The share of the variance of `y` that the line explains; 1 if all points lie on it.
    pub(crate) r2: f64,
    /// Root mean square of the distances of the points from the line, along `y`.
    pub(crate) residual: f64,
    /// How many points it was fitted to.
    pub(crate) points: usize,
}

impl Fit {
    /// The line with the least sum of squared distances along `y`. Points that are not finite are left out.
    /// `None` if fewer than two points differ in `x`.
    pub(crate) fn through(points: &[(f64, f64)]) -> Option<Self> {
        Self::weighted(points, |_| 1.0)
    }

    /// The line with the least sum of squared *relative* distances. The distance of a point is divided by its
    /// `y`, so small values weigh as much as large ones. Points with `y <= 0` are left out.
    pub(crate) fn relative(points: &[(f64, f64)]) -> Option<Self> {
        let points: Vec<(f64, f64)> = points.iter().copied().filter(|(_, y)| *y > 0.0).collect();
        Self::weighted(&points, |y| y.powi(-2))
    }

    fn weighted(points: &[(f64, f64)], weight: fn(f64) -> f64) -> Option<Self> {
        let points: Vec<(f64, f64)> =
            points.iter().copied().filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
        let count: f64 = points.iter().map(|(_, y)| weight(*y)).sum();
        let mean = |of: fn(&(f64, f64)) -> f64| {
            points.iter().map(|point| weight(point.1) * of(point)).sum::<f64>() / count
        };
        let (mean_x, mean_y) = (mean(|p| p.0), mean(|p| p.1));
        let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
            points.iter().map(|(x, y)| weight(*y) * of(x - mean_x, y - mean_y)).sum()
        };
        let (xx, xy, yy) = (sum(&|x, _| x * x), sum(&|x, y| x * y), sum(&|_, y| y * y));
        if points.len() < 2 || xx <= 0.0 || !xx.is_finite() {
            return None;
        }
        let slope = xy / xx;
        let squares = sum(&|x, y| (y - slope * x).powi(2));
        // A level line explains points on it, whatever variance rounding left.
        let r2 = if squares <= 1e-18 * count * mean_y.powi(2) { 1.0 } else { 1.0 - squares / yy };
        let residual = (squares / count).sqrt();
        Some(Self { slope, offset: mean_y - slope * mean_x, r2, residual, points: points.len() })
    }

    /// The largest relative distance of a point from the line, and the `x` of that point. NaN without points.
    pub(crate) fn worst(&self, points: &[(f64, f64)]) -> (f64, f64) {
        let off = |(x, y): &(f64, f64)| ((self.at(*x) / y - 1.0).abs(), *x);
        points.iter().map(off).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::NAN, f64::NAN))
    }

    /// The `y` of the line at an `x`.
    pub(crate) fn at(&self, x: f64) -> f64 {
        self.offset + self.slope * x
    }
}

#[cfg(test)]
mod tests {
    use super::Fit;

    #[test]
    fn points_on_a_line_give_that_line() {
        let points: Vec<(f64, f64)> =
            (0..9).map(|x| (f64::from(x) * 100.0, 3.0 + 0.25 * f64::from(x) * 100.0)).collect();
        let fit = Fit::through(&points).unwrap();
        assert!((fit.slope - 0.25).abs() < 1e-12 && (fit.offset - 3.0).abs() < 1e-9, "{fit:?}");
        assert!((fit.r2 - 1.0).abs() < 1e-12 && fit.residual < 1e-9 && fit.points == 9);
        assert!((fit.at(1_000.0) - 253.0).abs() < 1e-9);
    }

    #[test]
    fn anscombes_first_set_has_its_known_line() {
        // Anscombe 1973: y = 3.00 + 0.500 x, R2 = 0.667 in all four sets.
        let points = [
            (10.0, 8.04),
            (8.0, 6.95),
            (13.0, 7.58),
            (9.0, 8.81),
            (11.0, 8.33),
            (14.0, 9.96),
            (6.0, 7.24),
            (4.0, 4.26),
            (12.0, 10.84),
            (7.0, 4.82),
            (5.0, 5.68),
        ];
        let fit = Fit::through(&points).unwrap();
        assert!((fit.slope - 0.5001).abs() < 1e-4 && (fit.offset - 3.0001).abs() < 1e-4);
        assert!((fit.r2 - 0.6665).abs() < 1e-4, "{fit:?}");
        // The residual sum of squares is 13.763.
        assert!((fit.residual - (13.763_f64 / 11.0).sqrt()).abs() < 1e-3);
    }

    #[test]
    fn a_relative_line_goes_through_few_lights_too() {
        // Flat up to 1,000 lights, then proportional: the plain line follows the largest values.
        let points =
            [(100.0, 1.0), (1_000.0, 1.0), (3_000.0, 3.0), (10_000.0, 10.0), (30_000.0, 30.0)];
        let [plain, relative] = [Fit::through(&points), Fit::relative(&points)].map(Option::unwrap);
        assert!(plain.r2 > 0.99, "{plain:?}");
        let (off, at) = plain.worst(&points);
        assert!(off > 0.5 && at == 100.0, "{off} at {at}");
        assert!(relative.worst(&points).0 < off);
        // Points on a line stay on it, whatever their weights.
        let line: Vec<(f64, f64)> = points.iter().map(|(x, _)| (*x, 2.0 + 0.01 * x)).collect();
        let fit = Fit::relative(&line).unwrap();
        assert!((fit.slope - 0.01).abs() < 1e-9 && fit.worst(&line).0 < 1e-9, "{fit:?}");
    }

    #[test]
    fn a_line_does_not_explain_a_parabola() {
        let points: Vec<(f64, f64)> =
            (0..20).map(f64::from).map(|x| (x, (x - 9.5).powi(2))).collect();
        assert!(Fit::through(&points).unwrap().r2 < 0.01);
    }

    #[test]
    fn too_few_or_infinite_points_give_no_line() {
        assert_eq!(Fit::through(&[]), None);
        assert_eq!(Fit::through(&[(1.0, 2.0)]), None);
        assert_eq!(Fit::through(&[(1.0, 2.0), (1.0, 3.0)]), None);
        assert_eq!(Fit::through(&[(1.0, f64::NAN), (2.0, 3.0)]), None);
        let level = Fit::through(&[(1.0, 0.1), (2.0, 0.1), (3.0, 0.1)]).unwrap();
        assert_eq!((level.r2, level.slope.abs() < 1e-12), (1.0, true));
    }
}
