//! A command line with which a user starts PX4 themselves.

use crate::backend::launch::{Launch, shell_quoted};

/// Line that ends a file in the command line. No file contains it.
const END_OF_FILE: &str = "END_OF_SPANDREL_FILE";

/// Returns a shell command that creates the working directory and its files and starts PX4 there. `build` is the folder of PX4's
/// build, which contains `bin` and `etc`.
#[must_use]
pub fn shell_command(launch: &Launch, build: &str, directory: &str) -> String {
    let (build, directory) = (shell_quoted(build), shell_quoted(directory));
    let mut out = format!("(\nset -e\nBUILD=$(cd {build} && pwd)\nmkdir -p {directory}\ncd {directory}\n");
    for file in &launch.files {
        let name = shell_quoted(&file.name);
        out.push_str(&format!("cat > {name} <<'{END_OF_FILE}'\n{}{END_OF_FILE}\n", file.text));
        if file.executable {
            out.push_str(&format!("chmod +x {name}\n"));
        }
    }
    out.push_str("export PATH=\"$PWD:$BUILD/bin:$PATH\"\n");
    for (name, value) in &launch.environment {
        out.push_str(&format!("export {name}={}\n", shell_quoted(value)));
    }
    let args: Vec<String> = launch.args.iter().map(|arg| shell_quoted(arg)).collect();
    out.push_str(&format!("px4 {} \"$BUILD/etc\" < /dev/null\n)\n", args.join(" ")));
    out
}
