//! Rust structs that shaders read: declared once with their field table, so that a test can compare
//! names, offsets and size with the WGSL struct of the same name.

/// One member of a struct: its name and where it lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// The member's name. Names that start with `_` are padding.
    pub name: &'static str,
    /// Bytes from the struct's start.
    pub offset: usize,
}

/// What a test needs to know of a struct that both sides declare.
#[derive(Debug, Clone)]
pub struct StructInfo {
    /// The name on both sides.
    pub name: &'static str,
    /// The WGSL file that declares it, below `shaders/`.
    pub path: &'static str,
    /// Members in order.
    pub fields: Vec<Field>,
    /// Bytes.
    pub size: usize,
}

/// A struct that lies in a GPU buffer exactly as WGSL lays it out.
pub trait GpuStruct: bytemuck::Pod {
    /// Name, file and members.
    fn info() -> StructInfo;
}

/// Declares a [`GpuStruct`]: `gpu_struct! { "lib/view.wgsl", struct View { ... } }`.
#[macro_export]
macro_rules! gpu_struct {
    ($path:literal, $(#[$meta:meta])* pub struct $name:ident { $($(#[$field_meta:meta])* pub $field:ident: $type:ty,)* }) => {
        $(#[$meta])*
        #[repr(C)]
        #[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
        pub struct $name {
            $($(#[$field_meta])* pub $field: $type,)*
        }
        impl $crate::gpu::GpuStruct for $name {
            fn info() -> $crate::gpu::StructInfo {
                $crate::gpu::StructInfo {
                    name: stringify!($name),
                    path: $path,
                    fields: vec![$($crate::gpu::Field {
                        name: stringify!($field),
                        offset: std::mem::offset_of!($name, $field),
                    },)*],
                    size: size_of::<$name>(),
                }
            }
        }
    };
}
