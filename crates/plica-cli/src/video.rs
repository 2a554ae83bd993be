//! Conversion of animations to videos by ffmpeg.

use crate::failure::Failure;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The external program.
const FFMPEG: &str = "ffmpeg";

/// Returns whether a path names a video.
pub fn is_video(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "mp4")
}

/// Returns an error if ffmpeg is not available.
pub fn require_ffmpeg(path: &Path) -> Result<(), Failure> {
    let quiet = Command::new(FFMPEG)
        .arg("-version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    match quiet {
        Ok(status) if status.success() => Ok(()),
        _ => Err(Failure::Usage(format!(
            "--out {}: a video requires {FFMPEG}, which cannot be started; install it, or choose a file that ends in .apng",
            path.display()
        ))),
    }
}

/// Converts an animated PNG to a video whose last picture stays for `pause` more seconds. ffmpeg needs seekable files: two
/// temporary files are written beside `path`.
pub fn convert(apng: &[u8], path: &Path, pause: f64) -> Result<Vec<u8>, Failure> {
    // With the process, so that two conversions at a time do not share them.
    let process = std::process::id();
    let temporary =
        ["apng", "mp4"].map(|ending| path.with_extension(format!("part-{process}.{ending}")));
    let video = run_ffmpeg(apng, &temporary, pause)
        .map_err(|what| Failure::Files(format!("{}: {what}", path.display())));
    for file in &temporary {
        // It may not exist.
        let _ = std::fs::remove_file(file);
    }
    video
}

fn run_ffmpeg(apng: &[u8], [from, to]: &[PathBuf; 2], pause: f64) -> Result<Vec<u8>, String> {
    std::fs::write(from, apng).map_err(|error| error.to_string())?;
    let output = Command::new(FFMPEG)
        .args(["-loglevel", "error", "-y", "-i"])
        .arg(from)
        // All players support H.264 with this pixel format, which requires an even width and height.
        .arg("-vf")
        .arg(format!(
            "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,tpad=stop_mode=clone:stop_duration={pause:.3}"
        ))
        .args(["-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p"])
        .arg(to)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| error.to_string())?;
    if !output.status.success() {
        let words = String::from_utf8_lossy(&output.stderr);
        let last = words.lines().last().unwrap_or("failed").to_owned();
        return Err(format!("{FFMPEG}: {last}"));
    }
    std::fs::read(to).map_err(|error| error.to_string())
}
