//! Paints the number of lights per pixel over the scene.
//!
//! The scale is that of the comparison paper (Enhuber 2019, section 4.4): blue for no light, red
//! for [`HEAT_MAP_RED`] lights, green above that.

use crate::{HdrImage, ShadingError, image::encode_png};

/// The number of lights that is painted red. More lights are green.
pub const HEAT_MAP_RED: u32 = 150;

/// The share of the scale in a pixel's colour. The rest is the scene's brightness.
const OPACITY: f32 = 0.65;

/// The scale's colour, sRGB.
pub fn heat_color(lights: u32) -> [u8; 3] {
    if lights > HEAT_MAP_RED {
        return [0, 255, 0];
    }
    let red = lights as f32 / HEAT_MAP_RED as f32;
    [(red * 255.0).round() as u8, 0, ((1.0 - red) * 255.0).round() as u8]
}

/// A PNG of the scene in grey, covered with the scale. `lights` holds a number per pixel, rows from
/// the top. `None` means that there is no surface; such pixels stay black.
pub fn heat_map_png(
    image: &HdrImage,
    exposure: f32,
    lights: &[Option<u32>],
) -> Result<Vec<u8>, ShadingError> {
    let scene = image.tone_mapped(exposure);
    let blend = |(pixel, lights): (&[u8], &Option<u32>)| {
        let Some(lights) = lights else { return [0; 3] };
        let grey = pixel.iter().map(|&v| f32::from(v)).sum::<f32>() / 3.0;
        heat_color(*lights).map(|v| (OPACITY * f32::from(v) + (1.0 - OPACITY) * grey) as u8)
    };
    let bytes = scene.chunks_exact(3).zip(lights).flat_map(blend).collect();
    encode_png(image.width, image.height, bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_runs_from_blue_to_red_and_is_green_above() {
        assert_eq!(heat_color(0), [0, 0, 255]);
        assert_eq!(heat_color(75), [128, 0, 128]);
        assert_eq!(heat_color(150), [255, 0, 0]);
        assert_eq!(heat_color(151), [0, 255, 0]);
    }

    #[test]
    fn pixels_without_a_surface_stay_black() {
        let image = HdrImage { width: 3, height: 1, pixels: vec![[0.0; 3]; 3] };
        let png = heat_map_png(&image, 1.0, &[None, Some(0), Some(200)]).unwrap();
        let read = ::image::load_from_memory(&png).unwrap().to_rgb8();
        assert_eq!(read.as_raw()[..], [0, 0, 0, 0, 0, 165, 0, 165, 0]);
        // A pixel without a number is an error. The image must not become shorter.
        assert!(heat_map_png(&image, 1.0, &[None]).is_err());
    }
}
