//! Names along the way through a file's tree.

/// Bytes of a name that are kept, and of a path: its end tells more than its start.
const MAX_NAME: usize = 256;
const MAX_PATH: usize = 1024;

/// The names of the nodes from the root to where a walk is.
#[derive(Default)]
pub(super) struct TreePath {
    text: String,
}

impl TreePath {
    /// Steps into a node; gives what [`TreePath::leave`] needs.
    pub(super) fn enter(&mut self, name: &str) -> usize {
        let length = self.text.len();
        if length > 0 {
            self.text.push('/');
        }
        self.text.push_str(short_name(name));
        length
    }

    /// Steps back out of the node that gave `length` when it was entered.
    pub(super) fn leave(&mut self, length: usize) {
        self.text.truncate(length);
    }

    /// All names, joined by `/`; the last ones if the tree is very deep.
    pub(super) fn text(&self) -> String {
        let Some(cut) = self.text.len().checked_sub(MAX_PATH) else {
            return self.text.clone();
        };
        let is_separator = |&at: &usize| self.text.as_bytes()[at] == b'/';
        let start = (cut..self.text.len()).find(is_separator).unwrap_or(cut);
        format!("...{}", self.text.get(start..).unwrap_or_default())
    }
}

/// A name, cut where it is absurdly long.
pub(super) fn short_name(name: &str) -> &str {
    &name[..name.floor_char_boundary(MAX_NAME)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deep_paths_keep_their_last_names() {
        let mut path = TreePath::default();
        let root = path.enter("root");
        assert_eq!(root, 0);
        let lengths: Vec<usize> = (0..20_000).map(|i| path.enter(&format!("n{i}"))).collect();
        let text = path.text();
        assert!(text.len() <= MAX_PATH + 3 && text.starts_with(".../n") && text.ends_with("/n19999"), "{text}");
        path.leave(lengths[1]);
        assert_eq!(path.text(), "root/n0");
        assert_eq!(short_name(&"\u{e9}".repeat(200)).len(), 256);
    }
}
