//! Shapes that use some of a shared list of vertices get a list of their own.

/// No number yet.
const NONE: u32 = u32::MAX;

/// Renumbers triangles by the vertices that they use; the old number of each that is left, in the old order.
///
/// Time and memory follow the triangles, not the list: many shapes may share a long one. All indices are below `num_vertices`.
pub(super) fn compact(triangles: &mut [[u32; 3]], num_vertices: usize) -> Vec<u32> {
    if num_vertices / 12 > triangles.len() {
        let mut used: Vec<u32> = triangles.as_flattened().to_vec();
        used.sort_unstable();
        used.dedup();
        for index in triangles.as_flattened_mut() {
            *index = used.partition_point(|old| old < index) as u32;
        }
        return used;
    }
    let mut new_of_old = vec![NONE; num_vertices];
    for &index in triangles.as_flattened() {
        if let Some(new) = new_of_old.get_mut(index as usize) {
            *new = 0;
        }
    }
    let mut used = Vec::with_capacity(num_vertices);
    for (new, old) in new_of_old.iter_mut().zip(0..) {
        if *new != NONE {
            *new = used.len() as u32;
            used.push(old);
        }
    }
    for index in triangles.as_flattened_mut() {
        *index = new_of_old.get(*index as usize).copied().unwrap_or(0);
    }
    used
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unused_vertices_go_and_the_order_stays() {
        for num_vertices in [8, 1000] {
            let mut triangles = [[7, 2, 5], [2, 7, 3]];
            assert_eq!(compact(&mut triangles, num_vertices), [2, 3, 5, 7]);
            assert_eq!(triangles, [[3, 0, 2], [0, 3, 1]]);
        }
    }
}
