//! Which of some files changed, by the system's events and, where those fail, by looking.
//!
//! Folders are watched, not files: a file that an editor replaces takes its watch with it. Events on network drives, of
//! folders that are swapped, or beyond the system's limit never come, so that the files' sizes and times are looked at
//! now and then as well.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant, SystemTime};

use notify::event::{AccessKind, AccessMode, ModifyKind, RenameMode};
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher};

use super::pending::Touch;

/// Time between two looks at the files where events come, and where none do. Ours: what a glance at a clock takes, and
/// what feels immediate.
const LOOK_EVERY: Duration = Duration::from_millis(1000);
const LOOK_EVERY_WITHOUT_EVENTS: Duration = Duration::from_millis(100);

/// Longest chain of symbolic links that is followed, as long as the kernel's.
const MOST_LINKS: usize = 40;

/// What a look at a file tells: size, time of the last change, and which file it is.
type Look = Option<(u64, Option<SystemTime>, u64)>;

/// Watches groups of files; `G` names a group.
pub struct Watch<G> {
    watcher: Option<RecommendedWatcher>,
    events: Receiver<(Instant, notify::Event)>,
    groups: BTreeMap<G, BTreeSet<PathBuf>>,
    /// The groups that a name in a folder belongs to: each file, and every link on the way to it.
    names: BTreeMap<PathBuf, BTreeSet<G>>,
    /// Watched folders, and which folder each was.
    folders: BTreeMap<PathBuf, Look>,
    /// What each group knows of its files.
    looks: BTreeMap<(G, PathBuf), Look>,
    next_look: Instant,
}

impl<G: Copy + Ord> Watch<G> {
    /// Watches nothing yet.
    pub fn new() -> Watch<G> {
        let (sender, events) = channel();
        let handler = move |event: notify::Result<notify::Event>| {
            // An error is a lost event: the next look finds what it was about. Nobody listens once the watch is gone.
            if let Ok(event) = event {
                let _ = sender.send((Instant::now(), event));
            }
        };
        Watch {
            watcher: notify::recommended_watcher(handler).ok(),
            events,
            groups: BTreeMap::new(),
            names: BTreeMap::new(),
            folders: BTreeMap::new(),
            looks: BTreeMap::new(),
            next_look: Instant::now(),
        }
    }

    /// Replaces the files of a group.
    pub fn set(&mut self, group: G, files: impl IntoIterator<Item = PathBuf>) {
        let files: BTreeSet<PathBuf> =
            files.into_iter().map(|file| std::path::absolute(&file).unwrap_or(file)).collect();
        if self.groups.get(&group) != Some(&files) {
            self.groups.insert(group, files);
        }
        self.find_names();
    }

    /// The files of a group are about to be read as they are now: the next look is to find only what changes from here on, not once
    /// more what an event has told.
    pub fn will_read(&mut self, group: G) {
        for ((_, file), known) in self.looks.iter_mut().filter(|((of, _), _)| *of == group) {
            *known = look(file);
        }
    }

    /// Finds the names to listen for anew: links may lead elsewhere by now.
    fn find_names(&mut self) {
        self.names.clear();
        for (&group, files) in &self.groups {
            for name in files.iter().flat_map(|file| links(file)) {
                self.names.entry(name).or_default().insert(group);
            }
        }
        let groups = &self.groups;
        self.looks.retain(|(group, file), _| groups.get(group).is_some_and(|files| files.contains(file)));
        for (&group, files) in groups {
            for file in files {
                self.looks.entry((group, file.clone())).or_insert_with(|| look(file));
            }
        }
        self.watch_folders();
    }

    fn watch_folders(&mut self) {
        let Some(watcher) = &mut self.watcher else { return };
        let wanted: BTreeSet<PathBuf> = self.names.keys().filter_map(|name| Some(name.parent()?.to_owned())).collect();
        // A folder that was replaced took its watch with it.
        self.folders.retain(|folder, known| {
            let stays = wanted.contains(folder) && identity(folder) == *known;
            if !stays {
                // Fails where the system has dropped the watch already.
                let _ = watcher.unwatch(folder);
            }
            stays
        });
        for folder in wanted {
            if !self.folders.contains_key(&folder) && watcher.watch(&folder, RecursiveMode::NonRecursive).is_ok() {
                let known = identity(&folder);
                self.folders.insert(folder, known);
            }
        }
    }

    /// Waits at most `patience` for something to happen, then tells all that has happened.
    pub fn changes(&mut self, patience: Duration) -> Vec<(G, Touch, Instant)> {
        let mut touched = Vec::new();
        let until_look = self.next_look.saturating_duration_since(Instant::now());
        match self.events.recv_timeout(patience.min(until_look)) {
            Ok((at, event)) => self.note(at, &event, &mut touched),
            Err(RecvTimeoutError::Timeout) => {}
            // Without a watcher nobody sends.
            Err(RecvTimeoutError::Disconnected) => std::thread::sleep(patience.min(until_look)),
        }
        while let Ok((at, event)) = self.events.try_recv() {
            self.note(at, &event, &mut touched);
        }
        if self.next_look <= Instant::now() {
            self.look_around(&mut touched);
        }
        touched
    }

    fn note(&self, at: Instant, event: &notify::Event, touched: &mut Vec<(G, Touch, Instant)>) {
        let touch = match event.kind {
            EventKind::Access(AccessKind::Close(AccessMode::Write))
            | EventKind::Modify(ModifyKind::Name(RenameMode::To | RenameMode::Both)) => Touch::Settled,
            // Reading a file is no change; it would follow its own tail.
            EventKind::Access(_) => return,
            _ => Touch::Written,
        };
        for path in &event.paths {
            let groups = self.names.get(path).into_iter().flatten();
            touched.extend(groups.map(|&group| (group, touch, at)));
        }
    }

    /// Looks at every file, and watches folders that have come or were replaced.
    fn look_around(&mut self, touched: &mut Vec<(G, Touch, Instant)>) {
        let now = Instant::now();
        for ((group, file), known) in &mut self.looks {
            let seen = look(file);
            // What an event has told already is no news, and may be known to be whole.
            if seen != *known && !touched.iter().any(|(touched, _, _)| touched == group) {
                touched.push((*group, Touch::Written, now));
            }
            *known = seen;
        }
        self.find_names();
        let has_events = self.watcher.is_some()
            && self.names.keys().all(|name| name.parent().is_none_or(|folder| self.folders.contains_key(folder)));
        self.next_look = now + if has_events { LOOK_EVERY } else { LOOK_EVERY_WITHOUT_EVENTS };
    }
}

/// A file's name and, where it is a symbolic link, the names on the way to what it means.
fn links(file: &Path) -> Vec<PathBuf> {
    let mut names = vec![file.to_owned()];
    let mut name = file.to_owned();
    while names.len() < MOST_LINKS
        && let Ok(target) = std::fs::read_link(&name)
    {
        let folder = name.parent().unwrap_or(Path::new("/"));
        // The folder's own links and dots are resolved, so that the name is the one that events have.
        let next = folder.join(target);
        name = match (next.parent().and_then(|folder| folder.canonicalize().ok()), next.file_name()) {
            (Some(folder), Some(last)) => folder.join(last),
            _ => next,
        };
        names.push(name.clone());
    }
    names
}

fn look(file: &Path) -> Look {
    let metadata = std::fs::metadata(file).ok()?;
    Some((metadata.len(), metadata.modified().ok(), number(&metadata)))
}

/// Which folder lies at a path, whatever it holds.
fn identity(folder: &Path) -> Look {
    std::fs::metadata(folder).ok().map(|metadata| (0, None, number(&metadata)))
}

#[cfg(unix)]
fn number(metadata: &Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::ino(metadata)
}

#[cfg(not(unix))]
fn number(_: &Metadata) -> u64 {
    0
}
