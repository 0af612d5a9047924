//! The command `restyle`.

use std::process::ExitCode;

fn main() -> ExitCode {
    quiet_device_selection();
    restyle::cli::run()
}

/// Mesa's device-selection layer asks the desktop which GPU it prefers, and complains on stderr where there is no
/// desktop. There it has nothing to select, so it is switched off.
fn quiet_device_selection() {
    let unset = |name| std::env::var_os(name).is_none();
    if unset("XDG_RUNTIME_DIR") && unset("NODEVICE_SELECT") {
        // SAFETY: the process has only this thread yet.
        unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    }
}
