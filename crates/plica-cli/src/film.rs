//! Animated pictures as films, by ffmpeg where it is at hand.

use crate::failure::Failure;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The program that makes films.
const FFMPEG: &str = "ffmpeg";

/// Whether a file is to be a film, by its ending.
pub fn is_one(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "mp4")
}

/// Refuses a film where none can be made.
pub fn possible(path: &Path) -> Result<(), Failure> {
    let quiet = Command::new(FFMPEG)
        .arg("-version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    match quiet {
        Ok(status) if status.success() => Ok(()),
        _ => Err(Failure::Usage(format!(
            "--out {}: a film takes {FFMPEG}, which cannot be started here; install it, or let the file end in .apng",
            path.display()
        ))),
    }
}

/// An animated PNG as the bytes of a film, whose last picture stays for so many seconds more; by way of two files beside the one that it is to be, as neither format can be read
/// or written without going back.
pub fn of(apng: &[u8], path: &Path, rest: f64) -> Result<Vec<u8>, Failure> {
    let aside = [
        path.with_extension("part.apng"),
        path.with_extension("part.mp4"),
    ];
    let film = made(apng, &aside, rest)
        .map_err(|what| Failure::Files(format!("{}: {what}", path.display())));
    for file in &aside {
        // What was not made need not be removed.
        let _ = std::fs::remove_file(file);
    }
    film
}

fn made(apng: &[u8], [from, to]: &[PathBuf; 2], rest: f64) -> Result<Vec<u8>, String> {
    std::fs::write(from, apng).map_err(|error| error.to_string())?;
    let output = Command::new(FFMPEG)
        .args(["-loglevel", "error", "-y", "-i"])
        .arg(from)
        // Every player knows H.264 in this form, which takes even sides.
        .arg("-vf")
        .arg(format!(
            "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,tpad=stop_mode=clone:stop_duration={rest:.3}"
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
