//! Tests of the bond rules, on small arrangements of atoms.
