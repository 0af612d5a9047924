//! Vertices and normals as far as faces need to know them.

/// Vertices or normals: how many there are, and which of them are no numbers.
#[derive(Default)]
pub(super) struct Checked {
    count: u32,
    /// How many came before the face that is looked at.
    pub(super) before: u32,
    /// Numbers from 0, ascending.
    bad: Vec<u32>,
}

impl Checked {
    pub(super) fn push(&mut self, is_good: bool) {
        if !is_good {
            self.bad.push(self.count);
        }
        self.count = self.count.saturating_add(1);
    }

    /// The number, from 0, that an index means; none if there is no such thing.
    pub(super) fn resolve(&self, text: &[u8]) -> Option<u32> {
        let index: i64 = std::str::from_utf8(text).ok()?.parse().ok()?;
        let number = if index < 0 { i64::from(self.before).checked_add(index)? } else { index - 1 };
        u32::try_from(number).ok().filter(|&number| number < self.count)
    }

    pub(super) fn is_bad(&self, number: u32) -> bool {
        self.bad.binary_search(&number).is_ok()
    }
}
