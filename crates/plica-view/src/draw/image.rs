//! Pixels, and PNG in and out.

use super::DrawError;

/// The shortest side a picture may have, in pixels.
pub const MIN_SIDE: usize = 16;

/// The longest side a picture may have, in pixels.
pub const MAX_SIDE: usize = 8_000;

/// How a file is packed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Packing {
    /// Shades, to a small file: harder, a tenth smaller would take two and a half times as long.
    Small,
    /// Shades in a third of that time: files are a sixth larger, and three times as large where little is shaded.
    Fast,
    /// Lines and letters: rows of few colours, which filters would break.
    Plain,
}

/// A picture of 8-bit sRGB pixels, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `width * height` colours.
    pub pixels: Vec<[u8; 3]>,
}

impl Image {
    /// A white picture.
    ///
    /// # Errors
    /// As [`Image::size`].
    pub fn white(width: f64, height: f64) -> Result<Self, DrawError> {
        let [width, height] = Self::size(width, height)?;
        Ok(Self {
            width,
            height,
            pixels: vec![[255; 3]; width * height],
        })
    }

    /// The sides of a picture in whole pixels.
    ///
    /// # Errors
    /// [`DrawError::Size`] unless both lie between [`MIN_SIDE`] and [`MAX_SIDE`] pixels.
    pub fn size(width: f64, height: f64) -> Result<[usize; 2], DrawError> {
        let allowed = MIN_SIDE as f64..=MAX_SIDE as f64;
        if !allowed.contains(&width) || !allowed.contains(&height) {
            return Err(DrawError::Size { width, height });
        }
        Ok([width, height].map(|side| side.round() as usize))
    }

    /// Pictures one below the other, flush left, on white.
    ///
    /// # Errors
    /// [`DrawError::Size`] if they are too tall together, or none.
    pub fn stacked(images: &[Self]) -> Result<Self, DrawError> {
        let width = images.iter().map(|image| image.width).max().unwrap_or(0);
        let height: usize = images.iter().map(|image| image.height).sum();
        let mut page = Self::white(width as f64, height as f64)?;
        let mut below = 0;
        for image in images {
            page.stamp(image, 0, below);
            below += image.height as i64;
        }
        Ok(page)
    }

    /// Multiplies `stamp` into the picture with its top left corner at (x, y): white leaves the ground as it is.
    pub fn stamp(&mut self, stamp: &Image, x: i64, y: i64) {
        for (row, line) in stamp.pixels.chunks_exact(stamp.width.max(1)).enumerate() {
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
                let ground = &mut self.pixels[below as usize * self.width + across as usize];
                if *ground == [255; 3] {
                    *ground = *ink;
                    continue;
                }
                for (g, &i) in ground.iter_mut().zip(ink) {
                    *g = ((u16::from(*g) * u16::from(i) + 127) / 255) as u8;
                }
            }
        }
    }

    /// The picture as the bytes of a PNG file; `width_mm` sets the size it prints at.
    ///
    /// # Errors
    /// [`DrawError::Backend`] if the encoder refuses.
    pub fn to_png(&self, width_mm: f64, packing: Packing) -> Result<Vec<u8>, DrawError> {
        let backend = |e: png::EncodingError| DrawError::Backend(e.to_string());
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let level = png::DeflateCompression::Level(3);
        let (compression, filter) = match packing {
            Packing::Small => (level, png::Filter::Adaptive),
            Packing::Fast => (
                png::DeflateCompression::FdeflateUltraFast,
                png::Filter::Paeth,
            ),
            Packing::Plain => (level, png::Filter::NoFilter),
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

    /// Reads an 8-bit RGB or RGBA file; transparency is ignored.
    ///
    /// # Errors
    /// [`DrawError::Backend`] for anything else.
    pub fn from_png(bytes: &[u8]) -> Result<Self, DrawError> {
        let backend = |e: png::DecodingError| DrawError::Backend(e.to_string());
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .map_err(backend)?;
        let size = reader
            .output_buffer_size()
            .ok_or_else(|| DrawError::Backend("PNG too large".into()))?;
        let mut buffer = vec![0; size];
        let frame = reader.next_frame(&mut buffer).map_err(backend)?;
        let channels = match (frame.color_type, frame.bit_depth) {
            (png::ColorType::Rgb, png::BitDepth::Eight) => 3,
            (png::ColorType::Rgba, png::BitDepth::Eight) => 4,
            other => return Err(DrawError::Backend(format!("PNG of kind {other:?}"))),
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
        for packing in [Packing::Small, Packing::Fast, Packing::Plain] {
            let back = Image::from_png(&image.to_png(100.0, packing).unwrap()).unwrap();
            assert_eq!(back, image);
        }
    }

    #[test]
    fn pictures_are_stacked_in_their_order() {
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
    fn absurd_sizes_are_refused() {
        for (width, height) in [(0.0, 100.0), (f64::NAN, 100.0), (1e9, 100.0)] {
            assert!(matches!(
                Image::white(width, height),
                Err(DrawError::Size { .. })
            ));
        }
    }
}
