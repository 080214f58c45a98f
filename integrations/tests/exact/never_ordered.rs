//! Lights that the GPU should order, in frames that never have it do so.

use assign::{AssignError, EncoderPasses, Frame, LightBuffer, LightOrder};
use integrations::{Target, lights_at, open_device, split_screen};

use super::{LIGHTS, SIZE, STRATEGIES};

#[test]
fn lights_that_were_never_ordered_are_an_error_of_the_next_frame() {
    let gpu = open_device().unwrap();
    let target = Target::new(&gpu, wgpu::TextureFormat::R32Float, SIZE, 1);
    let view = split_screen(SIZE)[0].view;
    let given = lights_at(0.0, LIGHTS);
    for (name, make) in STRATEGIES {
        let order = LightOrder::Gpu { every: 1 };
        let mut lights = LightBuffer::ordered(&gpu, &given, order).unwrap();
        let mut strategy = make(&gpu).unwrap();
        let mut frame = |lights: &LightBuffer, is_ordered: bool, is_recorded: bool| {
            let frame = Frame::new(&view, lights).with_depth(&target.depth);
            strategy.prepare(&gpu, &frame)?;
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut passes = EncoderPasses { encoder: &mut encoder };
            if is_ordered {
                lights.record(&mut passes);
            }
            if is_recorded {
                strategy.record(&frame, &mut passes);
            }
            gpu.queue.submit([encoder.finish()]);
            Ok(())
        };
        let is_found = |result| matches!(result, Err(AssignError::LightsNotRecorded));
        // A frame that is prepared and then dropped reads nothing.
        frame(&lights, false, false).unwrap();
        frame(&lights, false, true).unwrap();
        for _ in 0..2 {
            assert!(is_found(frame(&lights, true, true)), "{name}: nothing ordered the lights");
            // The frame above ended with its error, before it ordered the lights.
        }
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        lights.record(&mut EncoderPasses { encoder: &mut encoder });
        gpu.queue.submit([encoder.finish()]);
        // Lights that stand still are ordered once.
        for _ in 0..2 {
            frame(&lights, false, true).unwrap();
        }
        lights.update(&gpu, &given).unwrap();
        frame(&lights, false, true).unwrap();
        lights.update(&gpu, &given).unwrap();
        assert!(is_found(frame(&lights, true, true)), "{name}: nothing ordered the new lights");
    }
}
