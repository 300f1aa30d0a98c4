//! Writes the seeds of every kind of file to a folder, `FOLDER/KIND/NAME`: what fuzzing begins with.
//!
//! `cargo run -p hostile-files --example seeds -- FOLDER`

use std::error::Error;
use std::path::PathBuf;

use hostile_files::KINDS;

fn main() -> Result<(), Box<dyn Error>> {
    let folder: PathBuf = std::env::args_os().nth(1).ok_or("give a folder")?.into();
    for kind in KINDS {
        let own = folder.join(kind.name);
        std::fs::create_dir_all(&own)?;
        for (name, bytes) in (kind.seeds)() {
            std::fs::write(own.join(name), bytes)?;
        }
    }
    Ok(())
}
