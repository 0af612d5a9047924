//! Which models of a file are read.

use crate::scene::error::SceneError;

/// Which models (PDB) or frames (XYZ) of a file are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ModelChoice {
    /// The first that has atoms.
    #[default]
    First,
    /// The one of this number: as `MODEL` says, or counted from 1 in XYZ files.
    Number(u32),
    /// All, one over the other.
    All,
}

/// Counts models and says which are wanted. Numbers always grow, whatever the file says.
#[derive(Debug)]
pub(super) struct Models {
    choice: ModelChoice,
    /// Number of the model that is being read, 0 before any.
    current: u32,
    current_has_atoms: bool,
    chosen: Option<u32>,
    first: Option<u32>,
    num_models: u32,
    num_wanted: u32,
}

impl Models {
    pub(super) fn new(choice: ModelChoice) -> Self {
        Self { choice, current: 0, current_has_atoms: false, chosen: None, first: None, num_models: 0, num_wanted: 0 }
    }

    /// Begins a model; a number that is missing or does not grow is replaced by the next one.
    pub(super) fn begin(&mut self, number: Option<u32>) {
        let next = self.current.saturating_add(1);
        // Before any atom a number may be anything, also 0.
        let is_free = |number: u32| number >= next || self.num_models == 0;
        self.current = number.filter(|&number| is_free(number)).unwrap_or(next);
        self.current_has_atoms = false;
    }

    /// Notes an atom of the current model; its number if the model is wanted.
    pub(super) fn atom(&mut self) -> Option<u32> {
        let wanted = match self.choice {
            ModelChoice::First => *self.chosen.get_or_insert(self.current) == self.current,
            ModelChoice::Number(number) => number == self.current,
            ModelChoice::All => true,
        };
        if !self.current_has_atoms {
            self.current_has_atoms = true;
            self.num_models = self.num_models.saturating_add(1);
            self.num_wanted += u32::from(wanted);
            self.first.get_or_insert(self.current);
        }
        wanted.then_some(self.current)
    }

    /// Models with atoms that were not wanted.
    pub(super) fn num_skipped(&self) -> u32 {
        self.num_models - self.num_wanted
    }

    /// The error of a number that no model has, if that is what happened.
    pub(super) fn missing(&self, file: &str) -> Option<SceneError> {
        let (ModelChoice::Number(model), Some(first), 0) = (self.choice, self.first, self.num_wanted) else {
            return None;
        };
        let available = match self.num_models {
            1 => format!("only model {first}"),
            count => format!("{count}, from {first} to {}", self.current),
        };
        Some(SceneError::NoSuchModel { file: file.to_string(), model, available })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_first_model_is_passed_over() {
        let mut models = Models::new(ModelChoice::First);
        models.begin(Some(1));
        models.begin(Some(2));
        assert_eq!(models.atom(), Some(2));
        models.begin(Some(3));
        assert_eq!(models.atom(), None);
        assert_eq!(models.num_skipped(), 1);
    }

    #[test]
    fn repeated_numbers_are_counted_on() {
        let mut models = Models::new(ModelChoice::All);
        let numbers = [Some(5), Some(5), None, Some(1)].map(|number| {
            models.begin(number);
            models.atom()
        });
        assert_eq!(numbers, [Some(5), Some(6), Some(7), Some(8)]);
    }

    #[test]
    fn a_missing_number_says_what_there_is() {
        let mut models = Models::new(ModelChoice::Number(9));
        models.begin(Some(0));
        assert_eq!(models.atom(), None);
        let message = models.missing("a.pdb").expect("an error").to_string();
        assert_eq!(message, "a.pdb: has no model 9; it has only model 0");
    }
}
