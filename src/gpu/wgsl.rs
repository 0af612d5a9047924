//! Shader text: files embedded in the program, joined into modules that remember which line came from where.

use std::collections::BTreeMap;

use super::{Gpu, GpuError};

/// Texts of files below `shaders/`, by their paths, that stand in for those that the program carries.
pub type ShaderEdits = BTreeMap<String, String>;

/// One WGSL file below `shaders/`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wgsl {
    /// Path below `shaders/`.
    pub path: &'static str,
    /// Its text.
    pub text: &'static str,
}

/// Embeds a file of `shaders/`: `wgsl!("lib/view.wgsl")`.
#[macro_export]
macro_rules! wgsl {
    ($path:literal) => {
        $crate::gpu::Wgsl { path: $path, text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $path)) }
    };
}

/// A shader module in the making: files and generated lines in order, each file once.
#[derive(Debug, Clone, Default)]
pub struct Module {
    parts: Vec<Part>,
}

#[derive(Debug, Clone)]
struct Part {
    /// Path below `shaders/`, or what generated lines are called.
    name: &'static str,
    text: String,
    is_file: bool,
}

impl Module {
    /// A module of these files.
    pub fn new(files: &[Wgsl]) -> Module {
        let mut module = Module::default();
        for file in files {
            module.add(*file);
        }
        module
    }

    /// Adds a file unless it is there already.
    pub fn add(&mut self, file: Wgsl) {
        if !self.parts.iter().any(|part| part.name == file.path) {
            self.parts.push(Part { name: file.path, text: file.text.to_owned(), is_file: true });
        }
    }

    /// Adds lines that code wrote, shown in messages as `name`.
    pub fn add_generated(&mut self, name: &'static str, text: String) {
        self.parts.push(Part { name, text, is_file: false });
    }

    /// The whole text.
    pub fn text(&self) -> String {
        let mut all = String::new();
        for part in &self.parts {
            all.push_str(&part.text);
            all.push('\n');
        }
        all
    }

    /// File and line of a line (from 1) of [`Module::text`].
    pub fn place(&self, line: usize) -> (&'static str, usize) {
        let mut left = line;
        for part in &self.parts {
            let lines = part.text.matches('\n').count() + 1;
            if left <= lines {
                return (part.name, left);
            }
            left -= lines;
        }
        ("end of module", left)
    }

    /// The same module with the files of a source tree that were changed since the program was built.
    fn with_edits(&self, edits: &ShaderEdits) -> Module {
        let edited = |part: &Part| match edits.get(part.name).filter(|_| part.is_file) {
            Some(text) => Part { text: text.clone(), ..part.clone() },
            None => part.clone(),
        };
        Module { parts: self.parts.iter().map(edited).collect() }
    }

    /// Compiles the module.
    ///
    /// # Errors
    /// [`GpuError::Shader`] with file and line of the first mistake.
    pub fn compile(&self, gpu: &Gpu, label: &'static str) -> Result<wgpu::ShaderModule, GpuError> {
        let edits = gpu.shader_edits();
        let is_edited = |part: &Part| part.is_file && edits.get(part.name).is_some_and(|text| *text != part.text);
        if self.parts.iter().any(is_edited) {
            self.with_edits(&edits).compile_text(gpu, label, true)
        } else {
            self.compile_text(gpu, label, false)
        }
    }

    fn compile_text(&self, gpu: &Gpu, label: &'static str, checked: bool) -> Result<wgpu::ShaderModule, GpuError> {
        let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let descriptor =
            wgpu::ShaderModuleDescriptor { label: Some(label), source: wgpu::ShaderSource::Wgsl(self.text().into()) };
        let module = if checked {
            gpu.device.create_shader_module(descriptor)
        } else {
            // SAFETY: this WGSL is part of the program. It indexes objects by instance numbers below their count and by
            // ids that its own passes wrote for them, and its loops end at constants. Without the checks loops unroll.
            unsafe { gpu.device.create_shader_module_trusted(descriptor, wgpu::ShaderRuntimeChecks::unchecked()) }
        };
        let error = pollster::block_on(scope.pop());
        if let Some(error) = error {
            let message = pollster::block_on(module.get_compilation_info())
                .messages
                .first()
                .and_then(|message| {
                    let at = message.location.as_ref()?;
                    let (file, line) = self.place(at.line_number as usize);
                    Some(format!("shaders/{file}:{line}:{}: {}", at.line_position, message.message))
                })
                .unwrap_or_else(|| error.to_string());
            return Err(GpuError::Shader(message));
        }
        Ok(module)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_traced_back_to_their_file() {
        let mut module = Module::default();
        module.add(Wgsl { path: "a.wgsl", text: "one\ntwo\n" });
        module.add(Wgsl { path: "b.wgsl", text: "three\n" });
        module.add(Wgsl { path: "a.wgsl", text: "one\ntwo\n" });
        let line = module.text().lines().position(|line| line == "three").map(|index| index + 1);
        assert_eq!(line.map(|line| module.place(line)), Some(("b.wgsl", 1)));
        assert_eq!(module.place(2), ("a.wgsl", 2));
    }
}
