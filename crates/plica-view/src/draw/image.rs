//! Images of 8-bit pixels, and PNG encoding.

use super::DrawError;

/// Smallest width or height of an image in pixels.
pub(super) const MIN_SIDE: usize = 16;

/// Largest width or height of an image in pixels.
pub(super) const MAX_SIDE: usize = 8_000;

/// Compression of a PNG file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Compression {
    /// Shaded images, small files. A stronger level saves a tenth of the size and takes 2.5 times as long.
    Small,
    /// Shaded images in a third of that time: files are a sixth larger, or three times as large if little is shaded.
    Fast,
    /// Line art with few colours, compressed without filters.
    LineArt,
}

/// An image of 8-bit sRGB pixels, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `width * height` pixels.
    pub pixels: Vec<[u8; 3]>,
}

impl Image {
    /// Creates a white image.
    ///
    /// # Errors
    /// [`DrawError::Size`] unless both sides are between 16 and 8000 pixels.
    pub fn white(width: f64, height: f64) -> Result<Self, DrawError> {
        let [width, height] = Self::size(width, height)?;
        Ok(Self {
            width,
            height,
            pixels: vec![[255; 3]; width * height],
        })
    }

    /// Rounds a width and a height to whole pixels.
    ///
    /// # Errors
    /// [`DrawError::Size`] unless both are between [`MIN_SIDE`] and [`MAX_SIDE`].
    pub(super) fn size(width: f64, height: f64) -> Result<[usize; 2], DrawError> {
        let allowed = MIN_SIDE as f64..=MAX_SIDE as f64;
        if !allowed.contains(&width) || !allowed.contains(&height) {
            return Err(DrawError::Size { width, height });
        }
        Ok([width, height].map(|side| side.round() as usize))
    }

    /// Stacks images vertically, aligned left, on white.
    ///
    /// # Errors
    /// [`DrawError::Size`] if there are none or if they are too tall together.
    pub fn stacked(images: &[Self]) -> Result<Self, DrawError> {
        let width = images.iter().map(|image| image.width).max().unwrap_or(0);
        let height: usize = images.iter().map(|image| image.height).sum();
        let mut page = Self::white(width as f64, height as f64)?;
        let mut below = 0;
        for image in images {
            page.multiply(image, 0, below);
            below += image.height as i64;
        }
        Ok(page)
    }

    /// Multiplies another image into this one with its top left corner at (x, y), so that its white is transparent.
    pub(super) fn multiply(&mut self, other: &Image, x: i64, y: i64) {
        for (row, line) in other.pixels.chunks_exact(other.width.max(1)).enumerate() {
            let below = y + row as i64;
            if below < 0 || below >= self.height as i64 {
                continue;
            }
            for (column, ink) in line.iter().enumerate() {
                if *ink == [255; 3] {
                    continue;
                }
                let across = x + column as i64;
                if across < 0 || across >= self.width as i64 {
                    continue;
                }
                let pixel = &mut self.pixels[below as usize * self.width + across as usize];
                if *pixel == [255; 3] {
                    *pixel = *ink;
                    continue;
                }
                for (p, &i) in pixel.iter_mut().zip(ink) {
                    *p = ((u16::from(*p) * u16::from(i) + 127) / 255) as u8;
                }
            }
        }
    }

    /// Encodes the image as a PNG file; `width_mm` is its printed width.
    ///
    /// # Errors
    /// [`DrawError::Backend`] if the encoder fails.
    pub fn to_png(&self, width_mm: f64, compression: Compression) -> Result<Vec<u8>, DrawError> {
        let backend = |e: png::EncodingError| DrawError::Backend(e.to_string());
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let level = png::DeflateCompression::Level(3);
        let (compression, filter) = match compression {
            Compression::Small => (level, png::Filter::Adaptive),
            Compression::Fast => (
                png::DeflateCompression::FdeflateUltraFast,
                png::Filter::Paeth,
            ),
            Compression::LineArt => (level, png::Filter::NoFilter),
        };
        encoder.set_deflate_compression(compression);
        encoder.set_filter(filter);
        if width_mm > 0.0 {
            let per_metre = (self.width as f64 / width_mm * 1000.0).round() as u32;
            let unit = png::Unit::Meter;
            encoder.set_pixel_dims(Some(png::PixelDimensions {
                xppu: per_metre,
                yppu: per_metre,
                unit,
            }));
        }
        let mut writer = encoder.write_header().map_err(backend)?;
        writer
            .write_image_data(self.pixels.as_flattened())
            .map_err(backend)?;
        writer.finish().map_err(backend)?;
        Ok(bytes)
    }

    /// Decodes an 8-bit RGB or RGBA PNG file; transparency is ignored.
    ///
    /// # Errors
    /// [`DrawError::Backend`] for any other file.
    pub fn from_png(bytes: &[u8]) -> Result<Self, DrawError> {
        let backend = |e: png::DecodingError| DrawError::Backend(e.to_string());
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .map_err(backend)?;
        let size = reader
            .output_buffer_size()
            .ok_or_else(|| DrawError::Backend("PNG file is too large".into()))?;
        let mut buffer = vec![0; size];
        let frame = reader.next_frame(&mut buffer).map_err(backend)?;
        let channels = match (frame.color_type, frame.bit_depth) {
            (png::ColorType::Rgb, png::BitDepth::Eight) => 3,
            (png::ColorType::Rgba, png::BitDepth::Eight) => 4,
            other => {
                return Err(DrawError::Backend(format!(
                    "unsupported PNG format {other:?}"
                )));
            }
        };
        let pixels = buffer[..frame.buffer_size()]
            .chunks_exact(channels)
            .map(|p| [p[0], p[1], p[2]])
            .collect();
        Ok(Self {
            width: frame.width as usize,
            height: frame.height as usize,
            pixels,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn png_round_trip() {
        let mut image = Image::white(20.0, 30.0).unwrap();
        image.pixels[19] = [10, 20, 30]; // top right
        for compression in [Compression::Small, Compression::Fast, Compression::LineArt] {
            let back = Image::from_png(&image.to_png(100.0, compression).unwrap()).unwrap();
            assert_eq!(back, image);
        }
    }

    #[test]
    fn images_are_stacked_in_order() {
        let dark = |width| {
            let mut image = Image::white(width, 20.0).unwrap();
            image.pixels[0] = [1, 2, 3];
            image
        };
        let page = Image::stacked(&[dark(30.0), dark(20.0)]).unwrap();
        assert_eq!((page.width, page.height), (30, 40));
        assert_eq!(
            (page.pixels[0], page.pixels[30 * 20]),
            ([1, 2, 3], [1, 2, 3])
        );
        assert!(matches!(Image::stacked(&[]), Err(DrawError::Size { .. })));
    }

    #[test]
    fn invalid_sizes_are_errors() {
        for (width, height) in [(0.0, 100.0), (f64::NAN, 100.0), (1e9, 100.0)] {
            assert!(matches!(
                Image::white(width, height),
                Err(DrawError::Size { .. })
            ));
        }
    }
}
