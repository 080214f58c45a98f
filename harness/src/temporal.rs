//! Temporal error: how much the error of an image changes from one frame to the next, such as by popping.

use crate::{image_errors::ImagePair, results::TemporalError};

/// The error of a frame, image minus reference by channel; `None` if both are the same in every bit.
type FrameError = Option<Vec<[f64; 3]>>;

/// Follows the images of one method from frame to frame.
#[derive(Default)]
pub struct Follower {
    before: Option<FrameError>,
    /// Pairs of frames so far.
    frames: u32,
    /// Channels of a frame, once one of them had an error.
    channels: usize,
    width: u32,
    sum: f64,
    worst: f64,
    worst_pixel: [u32; 2],
    worst_frame: u32,
}

impl Follower {
    /// Adds the next frame: its image and that of no culling; `None` if both are the same in every bit.
    pub fn follow(&mut self, pair: Option<&ImagePair<'_>>) {
        let error = |(a, b): (&[f32; 3], &[f32; 3])| {
            std::array::from_fn(|channel| f64::from(a[channel]) - f64::from(b[channel]))
        };
        let now = pair.map(|ImagePair { image, reference, .. }| {
            self.channels = 3 * image.pixels.len();
            self.width = image.width.max(1);
            image.pixels.iter().zip(&reference.pixels).map(error).collect()
        });
        if let Some(before) = self.before.take() {
            self.frames += 1;
            self.add(&before, &now);
        }
        self.before = Some(now);
    }

    fn add(&mut self, before: &FrameError, now: &FrameError) {
        let at = |error: &FrameError, ix: usize| {
            error.as_ref().and_then(|error| error.get(ix).copied()).unwrap_or_default()
        };
        let pixels = [before, now].into_iter().flatten().map(Vec::len).max().unwrap_or(0);
        for ix in 0..pixels {
            for (before, now) in at(before, ix).into_iter().zip(at(now, ix)) {
                // A channel that is not finite, in both frames or in one, is as wrong as can be.
                let change = (now - before).abs();
                let change = if change.is_nan() { f64::INFINITY } else { change };
                self.sum += change;
                if change > self.worst {
                    self.worst = change;
                    self.worst_pixel = [ix as u32 % self.width, ix as u32 / self.width];
                    self.worst_frame = self.frames;
                }
            }
        }
    }

    /// What was found; `None` before the second frame.
    pub fn found(&self) -> Option<TemporalError> {
        let finite = |number: f64| number.is_finite().then_some(number);
        (self.frames > 0).then(|| TemporalError {
            frames: self.frames,
            mean: finite(self.sum / (f64::from(self.frames) * self.channels.max(1) as f64)),
            worst: finite(self.worst),
            worst_pixel: self.worst_pixel,
            worst_frame: self.worst_frame,
        })
    }
}

#[cfg(test)]
mod tests {
    use shading::HdrImage;

    use super::*;

    /// The red of each pixel.
    type Red = fn(usize) -> f32;

    /// The found error of frames of 4 x 2 pixels, each with a reference.
    fn found(frames: &[(Red, Red)]) -> Option<TemporalError> {
        let image = |value: Red| {
            let pixels = (0..8).map(|ix| [value(ix), 1.0, 0.0]).collect();
            HdrImage { width: 4, height: 2, pixels }
        };
        let mut follower = Follower::default();
        for (shown, reference) in frames {
            let (shown, reference) = (image(*shown), image(*reference));
            let pair = ImagePair { image: &shown, reference: &reference, exposure: 1.0 };
            follower.follow(Some(&pair).filter(|_| shown != reference));
        }
        follower.found()
    }

    #[test]
    fn what_moves_in_both_images_and_a_steady_error_are_no_temporal_error() {
        assert_eq!(found(&[(|_| 1.0, |_| 1.0)]), None, "one frame has none before it");
        // The scene brightens, and the image is half as bright as it should be plus a constant.
        let steady = found(&[(|_| 1.0, |_| 2.0), (|_| 6.0, |_| 7.0), (|_| 3.0, |_| 4.0)]);
        let steady = steady.expect("three frames");
        assert_eq!((steady.frames, steady.mean, steady.worst), (2, Some(0.0), Some(0.0)));
        assert!(!steady.changes());
    }

    #[test]
    fn a_pop_is_found_with_its_pixel_and_frame() {
        let popped = |ix| if ix == 6 { 0.25 } else { 1.0 };
        let frames: [(Red, Red); 4] =
            [(|_| 1.0, |_| 1.0), (|_| 5.0, |_| 5.0), (popped, |_| 1.0), (popped, |_| 1.0)];
        let found = found(&frames).expect("four frames");
        // One channel of 24 changes by 0.75 in one of three pairs of frames.
        assert_eq!(found.worst, Some(0.75));
        assert!((found.mean.expect("finite") - 0.75 / 72.0).abs() < 1e-15, "{found:?}");
        assert_eq!((found.worst_pixel, found.worst_frame, found.frames), ([2, 1], 2, 3));
    }

    #[test]
    fn what_is_not_finite_is_found_too() {
        let found = found(&[(|_| 1.0, |_| 1.0), (|_| f32::NAN, |_| 1.0)]).expect("two frames");
        assert_eq!((found.mean, found.worst, found.worst_pixel), (None, None, [0, 0]));
        assert!(found.changes());
    }
}
