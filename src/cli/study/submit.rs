//! Scripts that compute a study on a cluster.

use crate::cli::arguments::{Globals, StudyArguments};
use crate::cli::terminal::print;

/// Prints an array job of Slurm with a shard for each index. A job that is killed and queued again goes on where it was,
/// and the one that ends last writes the table.
pub(super) fn print_script(arguments: &StudyArguments, name: &str, globals: &Globals) {
    let (file, out) = (arguments.file.display().to_string(), globals.out.display().to_string());
    let shards = arguments.shards;
    let mut settings = String::new();
    if globals.seed != 0 {
        settings.push_str(&format!(" --seed {}", globals.seed));
    }
    for (option, value) in [
        ("--max-steps", globals.max_steps),
        ("--max-modules", globals.max_modules),
        ("--max-samples", globals.max_samples),
        ("--max-memory", globals.max_memory.map(|bytes| bytes as u64)),
    ] {
        if let Some(value) = value {
            settings.push_str(&format!(" {option} {value}"));
        }
    }
    if let Some(root) = &globals.root {
        settings.push_str(&format!(" --root {}", quoted(&root.display().to_string())));
    }
    let script = format!(
        "#!/bin/bash\n\
         #SBATCH --job-name={name}\n\
         #SBATCH --array=1-{shards}\n\
         #SBATCH --cpus-per-task=1\n\
         #SBATCH --time=01:00:00\n\
         #SBATCH --requeue\n\
         #SBATCH --open-mode=append\n\
         # Submit it with `sbatch`, from this folder. Choose the number of shards such that each takes minutes. An index that\n\
         # is killed and queued again goes on where it was; the last one to end writes the table.\n\
         set -eu\n\
         exec modl study {} {name} --out {} --shard \"${{SLURM_ARRAY_TASK_ID}}/{shards}\" \\\n  \
         --threads \"${{SLURM_CPUS_PER_TASK:-1}}\"{settings}\n",
        quoted(&file),
        quoted(&out),
    );
    print(&script);
}

/// Returns a word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = word.chars().all(|c| c.is_ascii_alphanumeric() || "-_./".contains(c));
    if plain { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
