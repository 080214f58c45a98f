//! Builds deep images of a still scene until nothing overflows.

use assign::{AssignError, EncoderPasses, Gpu};

use crate::{DeepImages, Triangles};

/// The most builds until the buffers are large enough.
const MOST_BUILDS: u32 = 8;

impl DeepImages {
    /// Prepares and builds the images, in submissions of its own, until everything fits. It blocks.
    ///
    /// # Errors
    ///
    /// [`AssignError::TooLarge`] if the images do not fit, with what they need; those of
    /// [`prepare`](Self::prepare) and of the device.
    pub fn settle(&mut self, gpu: &Gpu, triangles: &Triangles<'_>) -> Result<(), AssignError> {
        for _ in 0..MOST_BUILDS {
            self.prepare(gpu, triangles)?;
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            self.record(&mut EncoderPasses { encoder: &mut encoder });
            gpu.queue.submit([encoder.finish()]);
            gpu.wait()?;
            // Before the next `prepare`, which would compare the counters of this build with larger buffers.
            self.readback.poll();
            if self.is_complete() == Some(true) {
                return Ok(());
            }
        }
        let fragments = self.stats().map_or(0, |stats| stats.fragment_count);
        Err(AssignError::TooLarge {
            what: format!("deep images of {fragments} fragments"),
            bytes: u64::from(fragments) * 4,
            limit: gpu.max_storage_bytes().min(u64::from(self.settings.most_fragments) * 4),
        })
    }
}
