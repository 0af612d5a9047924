//! `render --watch`: the picture follows the files until it is interrupted.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use super::rig::{Folder, Picture};

/// Longer than any step takes on a machine that does much else.
const PATIENCE: Duration = Duration::from_secs(60);

/// A command that watches, and the lines that it says.
struct Watching {
    child: Child,
    lines: Receiver<String>,
}

impl Watching {
    fn start(folder: &Folder, args: &str) -> Watching {
        let mut child = Command::new(env!("CARGO_BIN_EXE_restyle"))
            .args(args.split_whitespace())
            .current_dir(folder.path(""))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (sender, lines) = channel();
        let err = BufReader::new(child.stderr.take().unwrap());
        std::thread::spawn(move || err.lines().map_while(Result::ok).all(|line| sender.send(line).is_ok()));
        Watching { child, lines }
    }

    /// Waits for a line with these words.
    #[track_caller]
    fn says(&self, words: &str) -> String {
        let mut heard = Vec::new();
        loop {
            match self.lines.recv_timeout(PATIENCE) {
                Ok(line) if line.contains(words) => return line,
                Ok(line) => heard.push(line),
                Err(_) => panic!("{words:?} was not said, but {heard:?}"),
            }
        }
    }

    /// Interrupts it as Ctrl-C does.
    fn interrupt(mut self) -> Option<i32> {
        let pid = self.child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
        self.child.wait().unwrap().code()
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn ground(folder: &Folder) -> [u8; 3] {
    let bytes = Picture::read(folder, "o.png").bytes;
    [bytes[0], bytes[1], bytes[2]]
}

#[cfg(unix)]
#[test]
fn the_picture_follows_the_style_until_it_is_interrupted() {
    let Some(folder) = Folder::with_adapter("watch") else { return };
    folder.write("s.json", "{ \"camera\": { \"bgcolor\": [9, 8, 7] } }");
    let watching = Watching::start(&folder, "render water -s s.json -o o.png --size 8x8 --samples 1 --watch");
    watching.says("o.png: drawn in ");
    assert_eq!(ground(&folder), [9, 8, 7]);
    folder.write("s.json", "{ \"camera\": { \"bgcolor\": [1, 2, 3] } }");
    watching.says("o.png: drawn in ");
    assert_eq!(ground(&folder), [1, 2, 3]);
    folder.write("s.json", "{ \"camera\": { \"bgcolour\": [1, 2, 3] } }");
    watching.says("did you mean \"bgcolor\"?");
    watching.says("s.json: waiting for it to be mended; the picture stays as it is");
    assert_eq!(ground(&folder), [1, 2, 3]);
    folder.write("s.json", "{ \"camera\": { \"bgcolor\": [4, 5, 6] } }");
    watching.says("o.png: drawn in ");
    assert_eq!(ground(&folder), [4, 5, 6]);
    assert_eq!(watching.interrupt(), Some(0));
    assert_eq!(folder.names(), ["o.png", "s.json"]);
}

#[cfg(unix)]
#[test]
fn files_that_do_not_load_are_waited_for() {
    let Some(folder) = Folder::with_adapter("watch-first") else { return };
    let watching = Watching::start(&folder, "render m.xyz -s s.json -o o.png --size 8x8 --samples 1 --watch");
    watching.says("m.xyz: no such file");
    watching.says("s.json: there is no such file");
    folder.write("s.json", "{ \"camera\": { \"bgcolor\": [9, 8, 7] } }");
    folder.write("m.xyz", "1\n\nC 0 0 0\n");
    watching.says("o.png: drawn in ");
    assert_eq!(ground(&folder), [9, 8, 7]);
    assert_eq!(watching.interrupt(), Some(0));
}

#[cfg(unix)]
#[test]
fn every_scene_is_followed() {
    let Some(folder) = Folder::with_adapter("watch-scenes") else { return };
    folder.write("a.xyz", "1\n\nC 0 0 0\n").write("b.xyz", "1\n\nO 5 0 0\n");
    let watching = Watching::start(&folder, "render a.xyz water b.xyz -o o.png --size 8x8 --samples 1 --watch");
    watching.says("o.png: drawn in ");
    folder.write("b.xyz", "");
    watching.says("b.xyz: is empty");
    watching.says("a.xyz, water, b.xyz: waiting for it to be mended; the picture stays as it is");
    folder.write("b.xyz", "1\n\nO 6 0 0\n");
    watching.says("o.png: drawn in ");
    folder.write("a.xyz", "1\n\nC 1 0 0\n");
    watching.says("o.png: drawn in ");
    assert_eq!(watching.interrupt(), Some(0));
}

#[cfg(unix)]
#[test]
fn an_interrupt_breaks_a_long_still_off() {
    let Some(folder) = Folder::with_adapter("watch-long") else { return };
    folder.write("s.json", "{ \"camera\": { \"bgcolor\": [9, 8, 7] } }");
    let args = "render alpha_helix -s s.json -o o.png --size 2048x2048 --samples 1024 --watch";
    let watching = Watching::start(&folder, args);
    // Long enough for the still to begin, which would take minutes.
    std::thread::sleep(Duration::from_millis(700));
    assert_eq!(watching.interrupt(), Some(0));
    assert_eq!(folder.names(), ["s.json"]);
}

#[cfg(unix)]
#[test]
fn a_pipe_is_not_waited_for() {
    let Some(folder) = Folder::with_adapter("watch-pipe") else { return };
    let make_pipe = |name| assert!(Command::new("mkfifo").arg(folder.path(name)).status().unwrap().success());
    let args = "render water -s s.json -o o.png --size 8x8 --samples 1 --watch";
    make_pipe("s.json");
    let watching = Watching::start(&folder, args);
    watching.says("s.json: this is a pipe or a device: --watch follows files, so save it to one");
    std::fs::remove_file(folder.path("s.json")).unwrap();
    folder.write("s.json", "{ \"camera\": { \"bgcolor\": [9, 8, 7] } }");
    watching.says("o.png: drawn in ");
    make_pipe("base.json");
    folder.write("s.json", "{ \"extends\": \"base.json\" }");
    watching.says("cannot extend \"base.json\": this is a pipe or a device, not a style file");
    assert_eq!(ground(&folder), [9, 8, 7]);
    assert_eq!(watching.interrupt(), Some(0));
}

#[test]
fn what_never_changes_is_not_watched() {
    let Some(folder) = Folder::with_adapter("watch-shipped") else { return };
    folder.run("render c60 -s education -o o.png --watch").refused(2, "restyle copy education mine.json");
    folder.run("render c60 -s educatoin -o o.png --watch").refused(1, "did you mean \"education\"?");
    folder.run("render c60 -s education -o o.png --watch --frames 3").refused(2, "--frames");
    folder.write("s.json", "{}");
    folder.run("render c60 -s s.json --watch").refused(2, "nothing to write");
}
