//! The file's pictures, decoded for the screen.

use std::io::Cursor;
use std::sync::Arc;

use image::{DynamicImage, ImageReader, Limits, RgbImage, RgbaImage};
use image_webp::WebPDecoder;
use pliant_meshfile::{MeshFile, Picture, Textures, Wrapping};

use crate::viewport::{Texture, TextureSet, Wrap};

/// Width or height beyond which a picture is not decoded: a small file could ask for gigabytes.
const LARGEST_PICTURE: u32 = 8192;
/// Memory that decoding one picture may take: the largest one in 16 bits a channel.
const DECODING_BYTES: u64 = 512 << 20;
/// Width or height that is kept: more than a screen shows.
const LARGEST_SIDE: u32 = 4096;
/// Memory of all pictures of a model, smaller copies included: a dozen of 2048 × 2048, or three of the largest.
const ALL_BYTES: usize = 256 << 20;
/// Pictures that are named when they cannot be shown.
const NAMED: usize = 3;

/// What of the file's pictures can be shown.
pub(super) struct Decoded {
    /// The pictures on the surface, if there are any.
    pub(super) set: Option<Arc<TextureSet>>,
    /// Base color of every surface point, tints of pictures included, where there are pictures.
    pub(super) base_colors: Option<Arc<[[u8; 4]]>>,
    /// One sentence about those that cannot be shown.
    pub(super) warning: Option<String>,
}

/// Reads and decodes the file's pictures. Seconds for large ones: not for the window's thread.
pub(super) fn decode(file: &MeshFile) -> Decoded {
    let Textures { pictures, mut runs, uvs, mut missing } = file.textures();
    let mut images: Vec<Texture> = Vec::new();
    let mut kept = Vec::new();
    for picture in &pictures {
        kept.push(match decoded(picture) {
            Ok(texture) => {
                images.push(texture);
                shrink_to(&mut images, ALL_BYTES);
                Some(images.len() - 1)
            }
            Err(why) => {
                missing.push(format!("{} ({why})", picture.name));
                None
            }
        });
    }
    runs.iter_mut().for_each(|run| run.picture = run.picture.and_then(|picture| kept[picture]));
    let warning = warning(&missing);
    if images.is_empty() {
        return Decoded { set: None, base_colors: None, warning };
    }
    let tints = runs.iter().map(|run| (run.triangles.clone(), run.tint));
    let base_colors = super::model::colors_of(file, tints);
    let range = |range: std::ops::Range<usize>| range.start as u32..range.end as u32;
    let runs = runs.into_iter().map(|run| (range(run.triangles), run.picture)).collect();
    let set = Some(Arc::new(TextureSet { images, runs, uvs }));
    Decoded { set, base_colors: Some(base_colors), warning }
}

fn decoded(picture: &Picture) -> Result<Texture, String> {
    let is_webp = picture.bytes.starts_with(b"RIFF") && picture.bytes.get(8..12) == Some(b"WEBP");
    let mut image = if is_webp { webp(&picture.bytes)? } else { png_or_jpeg(&picture.bytes)? };
    image.pixels_mut().for_each(|pixel| pixel.0[3] = opacity(pixel.0[3], picture.cutout));
    let wrap = picture.wrapping.map(|wrapping| match wrapping {
        Wrapping::Repeat => Wrap::Repeat,
        Wrapping::Mirror => Wrap::Mirror,
        Wrapping::Clamp => Wrap::Clamp,
    });
    let mut texture = Texture::new(image, wrap);
    while texture.size.iter().any(|&side| side > LARGEST_SIDE) {
        texture.shrink();
    }
    Ok(texture)
}

/// What the renderer cuts out is less than half opaque: here the cutout of the file lies at the half. Smaller copies are
/// means, so it is no step.
fn opacity(alpha: u8, cutout: Option<f32>) -> u8 {
    let Some(cutout) = cutout else { return u8::MAX };
    ((f32::from(alpha) / 255.0 - cutout + 0.5).clamp(0.0, 1.0) * 255.0).round() as u8
}

fn png_or_jpeg(bytes: &[u8]) -> Result<RgbaImage, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| error.to_string())?;
    if reader.format().is_none() {
        return Err("not PNG, JPEG or WebP".into());
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST_PICTURE);
    limits.max_image_height = Some(LARGEST_PICTURE);
    limits.max_alloc = Some(DECODING_BYTES);
    reader.limits(limits);
    Ok(reader.decode().map_err(|error| error.to_string())?.into_rgba8())
}

/// Of a moving picture the first one.
fn webp(bytes: &[u8]) -> Result<RgbaImage, String> {
    let said = |error: image_webp::DecodingError| error.to_string();
    let mut decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(said)?;
    let (width, height) = decoder.dimensions();
    if width.max(height) > LARGEST_PICTURE {
        return Err(format!("{width} × {height} pixels are more than {LARGEST_PICTURE} a side"));
    }
    decoder.set_memory_limit(DECODING_BYTES as usize);
    let size = decoder.output_buffer_size().ok_or("it is too large")?;
    let mut pixels = vec![0; size];
    decoder.read_image(&mut pixels).map_err(said)?;
    let image = if decoder.has_alpha() {
        RgbaImage::from_raw(width, height, pixels)
    } else {
        RgbImage::from_raw(width, height, pixels).map(|image| DynamicImage::ImageRgb8(image).into_rgba8())
    };
    image.ok_or_else(|| "it has fewer pixels than it says".into())
}

/// Halves the largest until all together take no more than so many bytes.
fn shrink_to(images: &mut [Texture], most: usize) {
    while images.iter().map(Texture::bytes).sum::<usize>() > most {
        let Some(largest) = images.iter_mut().max_by_key(|image| image.bytes()) else { return };
        if largest.levels.len() < 2 {
            return;
        }
        largest.shrink();
    }
}

fn warning(missing: &[String]) -> Option<String> {
    let named = missing.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
    match missing.len() {
        0 => None,
        1 => Some(format!("a texture is not shown: {named}")),
        n if n <= NAMED => Some(format!("{n} textures are not shown: {named}")),
        n => Some(format!("{n} textures are not shown: {named} and others")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of one color, as PNG.
    fn png(side: u32) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let image = image::RgbaImage::from_pixel(side, side, image::Rgba([200, 30, 40, 255]));
        image.write_to(&mut bytes, image::ImageFormat::Png).expect("memory");
        bytes.into_inner()
    }

    fn picture(bytes: Vec<u8>) -> Picture {
        Picture { name: "red.png".into(), bytes, wrapping: [Wrapping::Clamp, Wrapping::Mirror], cutout: None }
    }

    #[test]
    fn pictures_are_decoded_within_limits() {
        let texture = decoded(&picture(png(32))).expect("a sound picture");
        assert_eq!((texture.size, texture.levels.len()), ([32, 32], 6));
        assert_eq!(texture.wrap, [Wrap::Clamp, Wrap::Mirror]);
        // The header of a picture of 60,000 x 60,000 pixels, without its rest.
        let mut large = png(32);
        large[16..24].copy_from_slice(&[0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60]);
        for bytes in [large, png(32)[..60].to_vec(), b"RIFF1234WEBPVP8 ".to_vec(), Vec::new()] {
            let why = decoded(&picture(bytes)).expect_err("cannot be shown");
            assert!(!why.is_empty() && !why.contains('\n'), "{why}");
        }
    }

    #[test]
    fn webp_pictures_are_decoded_with_and_without_opacity() {
        for color in [image_webp::ColorType::Rgb8, image_webp::ColorType::Rgba8] {
            let mut bytes = Vec::new();
            let pixel: &[u8] = if color == image_webp::ColorType::Rgb8 { &[200, 30, 40] } else { &[200, 30, 40, 90] };
            let encoder = image_webp::WebPEncoder::new(&mut bytes);
            encoder.encode(&pixel.repeat(64), 8, 8, color).expect("memory");
            let texture = decoded(&picture(bytes.clone())).expect("a sound picture");
            assert_eq!((texture.size, &texture.levels[0][..4]), ([8, 8], &[200, 30, 40, 255][..]), "{color:?}");
            assert!(decoded(&picture(bytes[..bytes.len() / 2].to_vec())).is_err(), "{color:?}, cut off");
        }
    }

    #[test]
    fn what_is_less_opaque_than_the_cutout_is_less_than_half_opaque() {
        for (alpha, cutout, is_there) in [(0, None, true), (127, Some(0.5), false), (128, Some(0.5), true)] {
            assert_eq!(opacity(alpha, cutout) >= 128, is_there, "{alpha} and {cutout:?}");
        }
        for (alpha, cutout, is_there) in [(60, Some(0.25), false), (70, Some(0.25), true), (255, Some(4.0), false)] {
            assert_eq!(opacity(alpha, cutout) >= 128, is_there, "{alpha} and {cutout:?}");
        }
    }

    #[test]
    fn the_largest_pictures_give_way_first() {
        let texture = |side| decoded(&picture(png(side))).expect("sound");
        let mut images = vec![texture(16), texture(64), texture(32)];
        shrink_to(&mut images, 13_000);
        assert_eq!(images.iter().map(|image| image.size[0]).collect::<Vec<_>>(), [16, 32, 32]);
        shrink_to(&mut images, 0);
        assert!(images.iter().all(|image| image.size == [1, 1]));
    }

    #[test]
    fn what_cannot_be_shown_is_said_once() {
        let names: Vec<String> = (0..5).map(|k| format!("{k}.png (why)")).collect();
        assert_eq!(warning(&[]), None);
        assert_eq!(warning(&names[..1]).as_deref(), Some("a texture is not shown: 0.png (why)"));
        let five = "5 textures are not shown: 0.png (why), 1.png (why), 2.png (why) and others";
        assert_eq!(warning(&names).as_deref(), Some(five));
    }
}
