//! Animated PNG files. Programs without support for animation show the first frame.

use super::{DrawError, Image};

/// The last frame of an animation is shown this many times longer than the others.
pub const LAST_FRAME_FACTOR: f64 = 8.0;

/// Encodes `count` frames as a looping animated PNG, each shown for `seconds`.
///
/// Frames are requested one at a time and not kept in memory. A frame that is `None` cancels: the result is `None`.
///
/// # Errors
/// [`DrawError::Empty`] without frames, [`DrawError::Backend`] if frames differ in size or the encoder fails, and errors of
/// the frames themselves.
pub fn animation(
    count: usize,
    frames: impl IntoIterator<Item = Result<Option<Image>, DrawError>>,
    seconds: f64,
) -> Result<Option<Vec<u8>>, DrawError> {
    let mut frames = frames.into_iter();
    let first = match frames.next() {
        None => return Err(DrawError::Empty { what: "animation" }),
        Some(first) => match first? {
            None => return Ok(None),
            Some(first) => first,
        },
    };
    let size = (first.width, first.height);
    let backend = |e: png::EncodingError| DrawError::Backend(e.to_string());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.0 as u32, size.1 as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_animated(count as u32, 0).map_err(backend)?;
    let mut writer = encoder.write_header().map_err(backend)?;
    for (i, frame) in std::iter::once(Ok(Some(first))).chain(frames).enumerate() {
        let Some(frame) = frame? else {
            return Ok(None);
        };
        if (frame.width, frame.height) != size {
            return Err(DrawError::Backend(format!(
                "frame {i} has {} x {} pixels, the first {} x {}",
                frame.width, frame.height, size.0, size.1
            )));
        }
        let last = i + 1 == count;
        let milliseconds = 1e3 * seconds * if last { LAST_FRAME_FACTOR } else { 1.0 };
        let milliseconds = milliseconds.round().clamp(1.0, 65_535.0) as u16;
        writer
            .set_frame_delay(milliseconds, 1000)
            .map_err(backend)?;
        writer
            .write_image_data(frame.pixels.as_flattened())
            .map_err(backend)?;
    }
    writer.finish().map_err(backend)?;
    Ok(Some(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_is_decoded_unchanged() {
        let frame = |shade: u8| {
            let mut image = Image::white(20.0, 16.0).unwrap();
            image.pixels[5] = [shade, 1, 2];
            image
        };
        let frames = [frame(10), frame(20), frame(30)];
        let given = |frames: &[Image]| frames.iter().cloned().map(Some).map(Ok).collect::<Vec<_>>();
        let bytes = animation(3, given(&frames), 0.1).unwrap().unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes))
            .read_info()
            .unwrap();
        let control = reader.info().animation_control.unwrap();
        assert_eq!((control.num_frames, control.num_plays), (3, 0));
        for frame in &frames {
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut pixels).unwrap();
            assert_eq!(pixels, frame.pixels.as_flattened());
        }
        let delay = reader.info().frame_control.unwrap();
        assert_eq!((delay.delay_num, delay.delay_den), (800, 1000));
    }

    #[test]
    fn frames_of_different_sizes_are_an_error() {
        let frames = [20.0, 21.0].map(|width| Image::white(width, 16.0).map(Some));
        assert!(matches!(
            animation(2, frames, 0.1),
            Err(DrawError::Backend(_))
        ));
        assert!(matches!(
            animation(0, [], 0.1),
            Err(DrawError::Empty { .. })
        ));
    }

    #[test]
    fn a_cancelled_animation_is_none() {
        let frames = [Image::white(20.0, 16.0).map(Some), Ok(None)];
        assert_eq!(animation(2, frames, 0.1).unwrap(), None);
    }
}
