//! Which operations an assembly is made of: expressions such as `1`, `1,2`, `1-60` and `(X0)(1-5,11-15)`.
//!
//! Groups in parentheses are multiplied, and the last one is applied first [MmCif, `oper_expression`].

use super::super::number;

/// Copies that an assembly may have. Ours: the largest virus capsids have 60, and crystals of them some hundreds.
pub(super) const MAX_COPIES: usize = 10_000;
/// Groups that are multiplied; real expressions have two.
const MAX_GROUPS: usize = 8;

/// The products of an expression: for each the ids of its factors, the one that is applied first last.
///
/// # Errors
/// What is wrong, in words.
pub(super) fn products(expression: &[u8]) -> Result<Vec<Vec<Vec<u8>>>, String> {
    let groups = groups(expression)?;
    let count = groups.iter().try_fold(1_usize, |count, group| count.checked_mul(group.len()));
    if count.is_none_or(|count| count > MAX_COPIES) {
        return Err(format!("means more than {MAX_COPIES} copies"));
    }
    let mut products: Vec<Vec<Vec<u8>>> = vec![Vec::new()];
    for group in &groups {
        let extended = |product: &Vec<Vec<u8>>| {
            let product = product.clone();
            group.iter().map(move |id| {
                let mut longer = product.clone();
                longer.push(id.clone());
                longer
            })
        };
        products = products.iter().flat_map(extended).collect();
    }
    Ok(products)
}

/// The ids of each group.
fn groups(expression: &[u8]) -> Result<Vec<Vec<Vec<u8>>>, String> {
    let mut groups = Vec::new();
    let mut rest = expression.trim_ascii();
    while !rest.is_empty() {
        let (group, after) = match rest.strip_prefix(b"(") {
            Some(inner) => {
                let end = memchr::memchr(b')', inner).ok_or("has a ( that is never closed")?;
                (&inner[..end], &inner[end + 1..])
            }
            None => rest.split_at(memchr::memchr(b'(', rest).unwrap_or(rest.len())),
        };
        if memchr::memchr2(b'(', b')', group).is_some() {
            return Err("has parentheses within others".to_string());
        }
        groups.push(ids(group)?);
        if groups.len() > MAX_GROUPS {
            return Err(format!("multiplies more than {MAX_GROUPS} groups"));
        }
        rest = after.trim_ascii();
    }
    if groups.is_empty() { Err("is empty".to_string()) } else { Ok(groups) }
}

/// The ids of a list such as `1-5,P`.
fn ids(list: &[u8]) -> Result<Vec<Vec<u8>>, String> {
    let mut ids = Vec::new();
    for item in list.split(|&byte| byte == b',').map(<[u8]>::trim_ascii) {
        let range = memchr::memchr(b'-', item)
            .and_then(|dash| Some((number::integer(&item[..dash])?, number::integer(&item[dash + 1..])?)));
        match range {
            _ if item.is_empty() => return Err("lacks an operation between its commas".to_string()),
            Some((first, last)) => {
                if last.saturating_sub(first) >= MAX_COPIES as i64 {
                    return Err(format!("means more than {MAX_COPIES} copies"));
                }
                ids.extend((first..=last).map(|number| number.to_string().into_bytes()));
            }
            None => ids.push(item.to_vec()),
        }
        if ids.len() > MAX_COPIES {
            return Err(format!("means more than {MAX_COPIES} copies"));
        }
    }
    Ok(ids)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(expression: &str) -> String {
        let products = products(expression.as_bytes()).unwrap_or_else(|what| panic!("{expression} {what}"));
        let product = |ids: Vec<Vec<u8>>| String::from_utf8(ids.join(&b'*')).expect("text");
        products.into_iter().map(product).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn lists_and_ranges_are_sums_and_groups_are_products() {
        assert_eq!(text("1"), "1");
        assert_eq!(text("1,2, P"), "1 2 P");
        assert_eq!(text("1-4"), "1 2 3 4");
        assert_eq!(text("(1-3)"), "1 2 3");
        assert_eq!(text("(X0)(1-2,11-12)"), "X0*1 X0*2 X0*11 X0*12");
        assert_eq!(text("(1,2)(3,4)"), "1*3 1*4 2*3 2*4");
        assert_eq!(text("P(1-2)"), "P*1 P*2");
        assert_eq!(text("(1-60)").split(' ').count(), 60);
    }

    #[test]
    fn nonsense_and_too_much_are_refused_before_memory_is_taken() {
        for (expression, what) in [
            ("", "is empty"),
            ("(1", "never closed"),
            ("((1))", "parentheses within"),
            ("1)", "parentheses within"),
            ("1,,2", "lacks an operation"),
            ("1-9999999999", "more than 10000"),
            ("-9223372036854775808-9223372036854775807", "more than"),
            ("(1-100)(1-101)", "more than 10000"),
            ("(1-9000)(1-9000)(1-9000)(1-9000)(1-9000)(1-9000)", "more than 10000"),
            ("(1)(1)(1)(1)(1)(1)(1)(1)(1)", "more than 8 groups"),
        ] {
            match products(expression.as_bytes()) {
                Err(message) => assert!(message.contains(what), "{expression}: {message}"),
                Ok(products) => assert_eq!((products.len(), what), (1, "more than"), "{expression}"),
            }
        }
    }
}
