//! The looks, molecules and meshes that are part of the program, so that their names work from any folder.

/// A file that the program carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shipped {
    /// Its name on the command line.
    pub name: &'static str,
    /// Its file name.
    pub file: &'static str,
    /// Its content.
    pub bytes: &'static [u8],
}

macro_rules! shipped {
    ($folder:literal, $($name:literal . $extension:literal),* $(,)?) => {
        &[$(Shipped {
            name: $name,
            file: concat!($name, ".", $extension),
            bytes: include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/", $folder, "/", $name, ".", $extension)),
        },)*]
    };
}

/// The looks, in the order of the published table.
pub const LOOKS: &[Shipped] = shipped!("styles", "advertisement"."json", "education"."json", "scientific"."json", "future"."json",
             "illustrative"."json", "technical"."json", "glass"."json", "xray"."json", "ghost"."json");

/// The molecules: the published table's four first.
pub const MOLECULES: &[Shipped] = shipped!(
    "molecules",
    "c60"."xyz",
    "arsenic_trioxide"."xyz",
    "anthracene"."xyz",
    "magnesium"."xyz",
    "methane"."xyz",
    "water"."xyz",
    "ammonia"."xyz",
    "benzene"."xyz",
    "caffeine"."xyz",
    "sulfur"."xyz",
    "ferrocene"."xyz",
    "diamond"."xyz",
    "sodium_chloride"."xyz",
    "nanotube"."xyz",
    "alpha_helix"."pdb",
);

/// The meshes.
pub const MESHES: &[Shipped] = shipped!("meshes", "gearbox"."glb", "bracket"."glb");

/// Everything that can be a scene. No name is in two of them.
pub const SCENES: [&[Shipped]; 2] = [MOLECULES, MESHES];

/// The shipped file of this name.
pub fn find(among: &'static [Shipped], name: &str) -> Option<&'static Shipped> {
    among.iter().find(|shipped| shipped.name == name)
}
