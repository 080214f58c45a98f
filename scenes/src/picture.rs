//! Rates the picture that a camera at a point would show, from rays in all directions.

/// The number of directions around a point.
pub(crate) const AZIMUTHS: usize = 24;

/// How many azimuths a picture shows on either side of its middle: 90 degrees in all.
const HALF_WINDOW: usize = 3;

/// Sums over the rays of one azimuth, all elevations. Distances are shares of the scene's diagonal.
#[derive(Clone, Copy, Default)]
pub(crate) struct Column {
    pub(crate) hits: f32,
    pub(crate) misses: f32,
    near: f32,
    pub(crate) lit: f32,
    far_sum: f32,
    log_sum: f32,
    log_square_sum: f32,
}

impl Column {
    pub(crate) fn add(&mut self, distance: f32) {
        let log = distance.max(1e-3).ln();
        self.hits += 1.0;
        self.near += f32::from(distance < 0.04);
        self.far_sum += distance / (distance + 0.15);
        self.log_sum += log;
        self.log_square_sum += log * log;
    }
}

/// The score of a picture around azimuth `middle`. It rewards far and varied depth, and punishes
/// near surfaces and more than a third of sky. Where the scene has lights, it rewards surfaces that
/// they reach.
pub(crate) fn picture_score(columns: &[Column; AZIMUTHS], middle: usize, has_lamps: bool) -> f32 {
    let mut all = Column::default();
    for offset in 0..=2 * HALF_WINDOW {
        let column = &columns[(middle + AZIMUTHS + offset - HALF_WINDOW) % AZIMUTHS];
        all.hits += column.hits;
        all.misses += column.misses;
        all.near += column.near;
        all.lit += column.lit;
        all.far_sum += column.far_sum;
        all.log_sum += column.log_sum;
        all.log_square_sum += column.log_square_sum;
    }
    if all.hits == 0.0 {
        return 0.0;
    }
    let rays = all.hits + all.misses;
    let mean_log = all.log_sum / all.hits;
    let spread = (all.log_square_sum / all.hits - mean_log * mean_log).max(0.0).sqrt();
    let sky = (all.misses / rays - 0.33).max(0.0);
    let near = all.near / rays;
    let lit = if has_lamps { 0.02 + all.lit / rays } else { 1.0 };
    lit * (all.far_sum / rays) * (1.0 + 0.6 * spread) * (1.0 - near) * (1.0 - 1.4 * sky).max(0.0)
}
