//! Tests of the program, and of the repository as a whole.

mod common;

mod broken;
mod changed_cases;
mod command_line;
mod export;
mod faults;
mod follow;
mod main_case;
mod materials;
mod mode_imperfections;
mod obstacles;
#[cfg(unix)]
mod removals;
mod render;
mod report;
mod reproduce;
mod resume;
mod stability;
mod start_state;
mod sweeps;
mod table;
mod threads;
mod unfinished;
mod verify;

mod architecture;
mod dependencies;
mod documents;
