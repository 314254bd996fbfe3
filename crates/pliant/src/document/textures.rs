//! The file's pictures, decoded for the screen.

use std::io::Cursor;
use std::sync::Arc;

use image::{ImageReader, Limits};
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
    let mut reader =
        ImageReader::new(Cursor::new(&picture.bytes)).with_guessed_format().map_err(|error| error.to_string())?;
    if reader.format().is_none() {
        return Err("neither PNG nor JPEG".into());
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST_PICTURE);
    limits.max_image_height = Some(LARGEST_PICTURE);
    limits.max_alloc = Some(DECODING_BYTES);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| error.to_string())?.into_rgba8();
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
        Picture { name: "red.png".into(), bytes, wrapping: [Wrapping::Clamp, Wrapping::Mirror] }
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
