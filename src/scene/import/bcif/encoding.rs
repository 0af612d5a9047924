//! Encodings of binary columns: what bytes become numbers by.
//!
//! After [Sehnal2020, throughout]. Encodings are listed in the order in which they were
//! applied and undone from the last. Lengths in the file are never trusted: nothing grows beyond a limit that the caller
//! derives from the size of the file.

use super::msgpack::Node;

/// Numbers of a column.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Numbers {
    Integers(Vec<i32>),
    Floats(Vec<f64>),
}

/// Undoes a list of encodings of some bytes; at most `limit` numbers.
///
/// # Errors
/// What is wrong, in words.
pub(super) fn decode(encodings: &[Node<'_>], bytes: &[u8], limit: usize) -> Result<Numbers, String> {
    let mut steps = encodings.iter().rev();
    let first = steps.next().ok_or("has no encoding")?;
    if first.get("kind").map(Node::text) != Some(b"ByteArray") {
        return Err(format!("has bytes encoded as {}", kind(first)));
    }
    let mut numbers = byte_array(first, bytes, limit)?;
    for step in steps {
        let Numbers::Integers(integers) = numbers else {
            return Err(format!("has {} of numbers that are no integers", kind(step)));
        };
        numbers = match step.get("kind").map(Node::text).unwrap_or_default() {
            b"FixedPoint" => fixed_point(step, &integers)?,
            b"IntervalQuantization" => interval_quantization(step, &integers)?,
            b"RunLength" => Numbers::Integers(run_length(&integers, limit)?),
            b"Delta" => Numbers::Integers(delta(step, integers)),
            b"IntegerPacking" => Numbers::Integers(integer_packing(step, &integers)?),
            _ => return Err(format!("has the encoding {}, which is not known", kind(step))),
        };
    }
    Ok(numbers)
}

/// The same for a column that must be integers.
pub(super) fn decode_integers(encodings: &[Node<'_>], bytes: &[u8], limit: usize) -> Result<Vec<i32>, String> {
    match decode(encodings, bytes, limit)? {
        Numbers::Integers(integers) => Ok(integers),
        Numbers::Floats(_) => Err("has numbers where integers belong".to_string()),
    }
}

/// The name of an encoding in a message.
pub(super) fn kind(encoding: &Node<'_>) -> String {
    super::super::lines::quote(encoding.get("kind").map(Node::text).unwrap_or_default())
}

/// Numbers as they are in memory, little-endian.
fn byte_array(encoding: &Node<'_>, bytes: &[u8], limit: usize) -> Result<Numbers, String> {
    let number = encoding.get("type").and_then(Node::integer).unwrap_or(0);
    let width = match number {
        1 | 4 => 1,
        2 | 5 => 2,
        3 | 6 | 32 => 4,
        33 => 8,
        _ => return Err(format!("has bytes of type {number}, which is not known")),
    };
    if !bytes.len().is_multiple_of(width) || bytes.len() / width > limit {
        return Err(format!("has {} bytes for numbers of {width} bytes", bytes.len()));
    }
    Ok(match number {
        1 => Numbers::Integers(bytes.iter().map(|&byte| i32::from(byte as i8)).collect()),
        4 => Numbers::Integers(bytes.iter().map(|&byte| i32::from(byte)).collect()),
        2 => Numbers::Integers(chunks(bytes).map(|chunk| i32::from(i16::from_le_bytes(chunk))).collect()),
        5 => Numbers::Integers(chunks(bytes).map(|chunk| i32::from(u16::from_le_bytes(chunk))).collect()),
        3 => Numbers::Integers(chunks(bytes).map(i32::from_le_bytes).collect()),
        6 => {
            let integer = |chunk| i32::try_from(u32::from_le_bytes(chunk)).ok();
            let integers: Option<Vec<i32>> = chunks(bytes).map(integer).collect();
            Numbers::Integers(integers.ok_or("has an integer above 2147483647")?)
        }
        32 => Numbers::Floats(chunks(bytes).map(|chunk| f64::from(f32::from_le_bytes(chunk))).collect()),
        _ => Numbers::Floats(chunks(bytes).map(f64::from_le_bytes).collect()),
    })
}

/// Pieces of equal length.
fn chunks<const N: usize>(bytes: &[u8]) -> impl Iterator<Item = [u8; N]> {
    bytes.as_chunks().0.iter().copied()
}

/// Decimal numbers times a factor.
fn fixed_point(encoding: &Node<'_>, integers: &[i32]) -> Result<Numbers, String> {
    let factor = encoding.get("factor").and_then(Node::float).filter(|&factor| factor != 0.0);
    let factor = factor.ok_or("has FixedPoint without a factor")?;
    Ok(Numbers::Floats(integers.iter().map(|&integer| f64::from(integer) / factor).collect()))
}

/// Steps between two numbers.
fn interval_quantization(encoding: &Node<'_>, integers: &[i32]) -> Result<Numbers, String> {
    let number = |key| encoding.get(key).and_then(Node::float);
    let (Some(low), Some(high), Some(num_steps)) = (number("min"), number("max"), number("numSteps")) else {
        return Err("has IntervalQuantization without min, max and numSteps".to_string());
    };
    let step = if num_steps > 1.0 { (high - low) / (num_steps - 1.0) } else { 0.0 };
    Ok(Numbers::Floats(integers.iter().map(|&integer| low + step * f64::from(integer)).collect()))
}

/// Pairs of a number and how often it comes.
fn run_length(integers: &[i32], limit: usize) -> Result<Vec<i32>, String> {
    let (pairs, rest) = integers.as_chunks::<2>();
    let mut total = 0_usize;
    for &[_, count] in pairs {
        let count = usize::try_from(count).map_err(|_| "has a run of negative length")?;
        total = total.saturating_add(count);
    }
    if !rest.is_empty() || total > limit {
        return Err("has runs longer than its table".to_string());
    }
    let mut expanded = Vec::with_capacity(total);
    for &[integer, count] in pairs {
        expanded.resize(expanded.len() + count as usize, integer);
    }
    Ok(expanded)
}

/// Differences to the number before.
fn delta(encoding: &Node<'_>, mut integers: Vec<i32>) -> Vec<i32> {
    let mut last = encoding.get("origin").and_then(Node::integer).unwrap_or(0) as i32;
    for integer in &mut integers {
        last = last.wrapping_add(*integer);
        *integer = last;
    }
    integers
}

/// Sums of small numbers: as long as one is the largest or smallest of its type, the next belongs to it.
fn integer_packing(encoding: &Node<'_>, integers: &[i32]) -> Result<Vec<i32>, String> {
    let is_unsigned = encoding.get("isUnsigned") == Some(&Node::True);
    let (low, high) = match (encoding.get("byteCount").and_then(Node::integer), is_unsigned) {
        (Some(1), true) => (-1, 0xff),
        (Some(1), false) => (-0x80, 0x7f),
        (Some(2), true) => (-1, 0xffff),
        (Some(2), false) => (-0x8000, 0x7fff),
        _ => return Err("has IntegerPacking of neither one nor two bytes".to_string()),
    };
    let (mut unpacked, mut sum) = (Vec::with_capacity(integers.len()), 0_i32);
    for &integer in integers {
        sum = sum.wrapping_add(integer);
        if integer != low && integer != high {
            unpacked.push(sum);
            sum = 0;
        }
    }
    unpacked.shrink_to_fit();
    Ok(unpacked)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encoding(kind: &'static str, pairs: &[(&'static str, Node<'static>)]) -> Node<'static> {
        let pairs = pairs.iter().map(|(key, value)| (key.as_bytes(), value.clone()));
        Node::Map(std::iter::once((b"kind".as_slice(), Node::Text(kind.as_bytes()))).chain(pairs).collect())
    }

    fn bytes_of(number: i64) -> Node<'static> {
        encoding("ByteArray", &[("type", Node::Integer(number))])
    }

    fn integers(steps: &[Node<'_>], bytes: &[u8]) -> Vec<i32> {
        decode_integers(steps, bytes, 1000).expect("integers")
    }

    fn floats(steps: &[Node<'_>], bytes: &[u8]) -> Vec<f64> {
        match decode(steps, bytes, 1000) {
            Ok(Numbers::Floats(floats)) => floats,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn byte_arrays_are_little_endian() {
        assert_eq!(integers(&[bytes_of(1)], &[0xff, 1]), [-1, 1]);
        assert_eq!(integers(&[bytes_of(2)], &[0xfe, 0xff]), [-2]);
        assert_eq!(integers(&[bytes_of(3)], &[1, 0, 0, 0x80]), [i32::MIN + 1]);
        assert_eq!(integers(&[bytes_of(4)], &[0xff]), [255]);
        assert_eq!(integers(&[bytes_of(5)], &[0xff, 0xff]), [65_535]);
        assert_eq!(integers(&[bytes_of(6)], &[2, 0, 0, 0]), [2]);
        assert_eq!(floats(&[bytes_of(32)], &1.5_f32.to_le_bytes()), [1.5]);
        assert_eq!(floats(&[bytes_of(33)], &(-0.1_f64).to_le_bytes()), [-0.1]);
    }

    #[test]
    fn each_step_is_undone() {
        let fixed = encoding("FixedPoint", &[("factor", Node::Integer(1000)), ("srcType", Node::Integer(33))]);
        assert_eq!(floats(&[fixed, bytes_of(2)], &[0x39, 0x30, 0xff, 0xff]), [12.345, -0.001]);
        let steps = [("min", Node::Float(0.5)), ("max", Node::Float(2.5)), ("numSteps", Node::Integer(5))];
        let interval = encoding("IntervalQuantization", &steps);
        assert_eq!(floats(&[interval, bytes_of(4)], &[0, 1, 4]), [0.5, 1.0, 2.5]);
        assert_eq!(integers(&[encoding("RunLength", &[]), bytes_of(1)], &[0xff, 2, 7, 1]), [-1, -1, 7]);
        let delta = encoding("Delta", &[("origin", Node::Integer(1000))]);
        assert_eq!(integers(&[delta, bytes_of(1)], &[0, 3, 2, 1, 0xff]), [1000, 1003, 1005, 1006, 1005]);
        let packing = |width, is_unsigned: bool| {
            let sign = if is_unsigned { Node::True } else { Node::Other };
            encoding("IntegerPacking", &[("byteCount", Node::Integer(width)), ("isUnsigned", sign)])
        };
        assert_eq!(integers(&[packing(1, true), bytes_of(4)], &[1, 255, 0, 255, 255, 3]), [1, 255, 513]);
        assert_eq!(integers(&[packing(1, false), bytes_of(1)], &[1, 0x7f, 0x7f, 1, 0x80, 0xff]), [1, 255, -129]);
    }

    #[test]
    fn steps_follow_each_other_from_the_last() {
        let steps = [encoding("Delta", &[("origin", Node::Integer(5))]), encoding("RunLength", &[]), bytes_of(1)];
        assert_eq!(integers(&steps, &[1, 3]), [6, 7, 8]);
    }

    #[test]
    fn lies_are_refused() {
        let fails = |steps: &[Node<'_>], bytes: &[u8]| decode(steps, bytes, 10).expect_err("refused");
        assert!(
            fails(&[encoding("RunLength", &[]), bytes_of(3)], &[1, 0, 0, 0, 0xff, 0xff, 0xff, 0x7f]).contains("longer")
        );
        assert!(fails(&[encoding("RunLength", &[]), bytes_of(1)], &[1, 0xff]).contains("negative"));
        assert!(fails(&[bytes_of(3)], &[1, 2, 3]).contains("3 bytes"));
        assert!(fails(&[bytes_of(4)], &[0; 11]).contains("11 bytes"));
        assert!(fails(&[bytes_of(9)], &[]).contains("type 9"));
        assert!(fails(&[encoding("Zip", &[]), bytes_of(1)], &[]).contains("\"Zip\""));
        assert!(fails(&[], &[]).contains("no encoding"));
        assert!(fails(&[encoding("Delta", &[])], &[]).contains("\"Delta\""));
        assert!(fails(&[encoding("FixedPoint", &[]), bytes_of(1)], &[]).contains("without a factor"));
    }
}
