//! `plica render` and `plica animate`.

use crate::args::{AnimateArguments, LookArguments, RenderArguments};
use crate::existing_run::{ExistingRun, check_out};
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::ticker::Ticker;
use crate::video;
use crate::{console, threads};
use plica_view::draw::{DrawError, LAST_FRAME_FACTOR};
use plica_view::report::{self, Appearance, Field, FieldScales, Shown};
use rayon::prelude::*;
use std::sync::Mutex;

/// Named directions towards the viewer: (up, near, along the tube).
pub const VIEWS: [(&str, [f64; 3]); 5] = [
    ("oblique", [0.42, 1.0, -0.35]),
    ("front", [0.0, 1.0, 0.0]),
    ("above", [1.0, 0.35, 0.0]),
    ("colon", [0.3, 0.5, -1.0]),
    ("ileum", [0.3, 0.5, 1.0]),
];

/// Largest number of states in one picture.
const MOST: usize = 12;

/// Draws states of a run.
pub fn render(arguments: &RenderArguments) -> Result<(), Failure> {
    let run = ExistingRun::open(&arguments.run)?;
    run.check_saved(&arguments.state)?;
    if let Some(path) = &arguments.look.out {
        check_out(path, &["png"])?;
    }
    if arguments.state.len() > MOST {
        return Err(Failure::Usage(format!(
            "--state: {} states in one picture are too many; {MOST} at most",
            arguments.state.len()
        )));
    }
    threads::limit(arguments.look.threads)?;
    let numbers = match arguments.state.as_slice() {
        [] => vec![run.last()?],
        states => states.to_vec(),
    };
    let look = appearance(&arguments.look);
    let states: Result<Vec<Shown>, Failure> = numbers.iter().map(|&n| run.state(n)).collect();
    let path = run.field_scales();
    let png = report::render(&run.plan, &states?, &path, &look).map_err(failure)?;
    let names: Vec<String> = numbers.iter().map(|n| format!("{n:04}")).collect();
    let name = format!("{}-state-{}.png", look.field.name(), names.join("-"));
    run.write_picture(arguments.look.out.as_deref(), &name, &png)
}

/// Draws all saved states of a run as an animation.
pub fn animate(arguments: &AnimateArguments) -> Result<(), Failure> {
    let run = ExistingRun::open(&arguments.run)?;
    run.last()?;
    threads::limit(arguments.look.threads)?;
    let look = appearance(&arguments.look);
    if let Some(path) = &arguments.look.out {
        check_out(path, &["apng", "png", "mp4"])?;
    }
    let video = arguments.look.out.as_deref();
    let video = video.filter(|path| video::is_video(path));
    if let Some(path) = video {
        video::require_ffmpeg(path)?;
    }
    let interrupt = Interrupt::listen()?;
    let numbers: Vec<usize> = run.saved.keys().copied().collect();
    // An unreadable state does not prevent the animation of the others.
    let mut states: Vec<Shown> = vec![];
    for &number in &numbers {
        match run.try_state(number) {
            Ok(shown) => states.push(shown),
            Err(why) => console::message(&format!("warning: state skipped: {why}")),
        }
    }
    let ticker = Mutex::new(Ticker::new(interrupt));
    let monitor = |done: usize| {
        let ticker = ticker.lock().unwrap_or_else(|e| e.into_inner());
        ticker.working("drawing", done as f64 / states.len() as f64);
        !ticker.stop()
    };
    let seconds = 1.0 / arguments.fps;
    let path = FieldScales::of_states(&run.plan, states.par_iter().map(|(state, _)| state));
    let drawn = report::animate(
        &run.plan, &states, &run.rows, &path, &look, seconds, &monitor,
    );
    ticker
        .into_inner()
        .unwrap_or_else(|e| e.into_inner())
        .finish();
    match drawn.map_err(failure)? {
        Some(bytes) => {
            let bytes = match video {
                Some(path) => video::convert(&bytes, path, seconds * (LAST_FRAME_FACTOR - 1.0))?,
                None => bytes,
            };
            let name = format!("{}-path.apng", look.field.name());
            run.write_picture(arguments.look.out.as_deref(), &name, &bytes)
        }
        None => Err(Failure::Interrupted(
            "interrupted; nothing was written".into(),
        )),
    }
}

/// Returns the appearance that the arguments describe.
fn appearance(arguments: &LookArguments) -> Appearance {
    let field = Field::ALL
        .into_iter()
        .find(|field| field.name() == arguments.field);
    Appearance {
        field: field.unwrap_or_default(),
        cutaway: arguments.cutaway,
        see_through: arguments.see_through,
        toward: arguments.view,
        scale: arguments.range,
        width: usize::from(arguments.width),
    }
}

/// Converts an error of drawing: a request that cannot be met, or an internal error.
pub fn failure(error: DrawError) -> Failure {
    match error {
        DrawError::Backend(_) | DrawError::Grid { .. } => Failure::Fault(error.to_string()),
        DrawError::Size { .. } => {
            Failure::Usage(format!("{error}; choose fewer states or a smaller --width"))
        }
        _ => Failure::Usage(error.to_string()),
    }
}
