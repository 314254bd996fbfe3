//! The comparison as one picture: what is on screen, cut out of the window and written as PNG.

use std::path::Path;

use image::RgbaImage;

/// The part of a picture of `size` pixels (RGBA, row by row) within a rectangle: left, top, width, height. It is cut off
/// where it is outside; none if nothing is left.
pub(crate) fn crop(pixels: &[[u8; 4]], size: [usize; 2], [left, top, width, height]: [usize; 4]) -> Option<RgbaImage> {
    let [all_width, all_height] = size;
    let (right, bottom) = ((left + width).min(all_width), (top + height).min(all_height));
    if left >= right || top >= bottom || pixels.len() < all_width * all_height {
        return None;
    }
    let rows = (top..bottom).map(|y| &pixels[y * all_width + left..y * all_width + right]);
    // The window is opaque, whatever its pixels say.
    let bytes = rows.flatten().flat_map(|&[r, g, b, _]| [r, g, b, 255]).collect();
    RgbaImage::from_raw((right - left) as u32, (bottom - top) as u32, bytes)
}

/// Writes a picture as PNG, in place of what was there only when it is whole.
///
/// # Errors
/// What could not be written, and why.
pub(crate) fn write_picture(picture: &RgbaImage, to: &Path) -> Result<(), String> {
    let failed = |why: String| format!("{} could not be written: {why}", to.display());
    let mut name = to.file_name().ok_or_else(|| failed("it names no file".into()))?.to_owned();
    name.push(format!(".{}.tmp", std::process::id()));
    let temporary = to.with_file_name(name);
    let written = picture
        .save_with_format(&temporary, image::ImageFormat::Png)
        .map_err(|error| error.to_string())
        .and_then(|()| std::fs::rename(&temporary, to).map_err(|error| error.to_string()));
    if written.is_err() {
        // Nothing may be there, and nobody waits for it.
        let _ = std::fs::remove_file(&temporary);
    }
    written.map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_is_cut_out_and_cut_off_at_the_border() {
        let pixels: Vec<[u8; 4]> = (0..12).map(|k| [k, 0, 0, 0]).collect();
        let cut = crop(&pixels, [4, 3], [1, 1, 2, 1]).expect("within");
        assert_eq!((cut.dimensions(), cut.as_raw().as_slice()), ((2, 1), &[5, 0, 0, 255, 6, 0, 0, 255][..]));
        assert_eq!(crop(&pixels, [4, 3], [3, 2, 9, 9]).expect("a corner").dimensions(), (1, 1));
        assert_eq!(crop(&pixels, [4, 3], [4, 0, 1, 1]), None);
        assert_eq!(crop(&pixels[1..], [4, 3], [0, 0, 1, 1]), None);
    }

    #[test]
    fn a_picture_is_written_whole_or_not_at_all() {
        let folder = tempfile::tempdir().expect("a new folder");
        let picture = RgbaImage::from_pixel(3, 2, image::Rgba([1, 2, 3, 255]));
        let to = folder.path().join("all.png");
        write_picture(&picture, &to).expect("a folder to write to");
        assert_eq!(image::open(&to).expect("a picture").to_rgba8(), picture);
        assert!(write_picture(&picture, &folder.path().join("no/such/folder.png")).is_err());
        assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 1);
    }
}
