//! Elements of the SMORES tools' XML files, with the place of what is wrong.

use super::{ImportFault, Node};

/// Returns the only child of a name.
pub(super) fn child<'a>(node: Node<'a, 'a>, name: &str) -> Result<Node<'a, 'a>, ImportFault> {
    let mut found = node.children().filter(|child| child.has_tag_name(name));
    let here = node.tag_name().name();
    let first =
        found.next().ok_or_else(|| ImportFault::at_node(node, format!("`<{here}>` without `<{name}>`")))?;
    match found.next() {
        Some(second) => Err(ImportFault::at_node(second, format!("`<{here}>` with two `<{name}>`"))),
        None => Ok(first),
    }
}

/// Returns the children of a name; those of another name are a fault.
pub(super) fn children<'a>(node: Node<'a, 'a>, name: &str) -> Result<Vec<Node<'a, 'a>>, ImportFault> {
    let all = node.children().filter(Node::is_element).map(|child| {
        if child.has_tag_name(name) {
            return Ok(child);
        }
        let found = child.tag_name().name();
        Err(ImportFault::at_node(child, format!("`<{name}>` is wanted here, and this is `<{found}>`")))
    });
    all.collect()
}

/// Returns the text of the child of a name, without the blanks around it.
pub(super) fn text<'a>(node: Node<'a, 'a>, name: &str) -> Result<&'a str, ImportFault> {
    Ok(child(node, name)?.text().unwrap_or("").trim())
}

/// Returns the finite number in the child of a name.
pub(super) fn number(node: Node, name: &str) -> Result<f64, ImportFault> {
    let [number] = *numbers(node, name, &[1])? else {
        return Err(ImportFault::at_node(node, "a number is wanted"));
    };
    Ok(number)
}

/// Returns the finite numbers in the child of a name, as many as one of `counts`.
pub(super) fn numbers(node: Node, name: &str, counts: &[usize]) -> Result<Vec<f64>, ImportFault> {
    // The place is that of the child, whose text lives as long as the document.
    let stated = node.children().find(|child| child.has_tag_name(name));
    let at = stated.unwrap_or(node);
    let text = stated.and_then(|child| child.text()).unwrap_or("");
    let words = text.split_whitespace();
    let read: Vec<f64> =
        words.clone().filter_map(|word| word.parse().ok()).filter(|x: &f64| x.is_finite()).collect();
    if counts.contains(&read.len()) && words.count() == read.len() {
        return Ok(read);
    }
    let wanted: Vec<String> = counts.iter().map(usize::to_string).collect();
    let numbers = if counts == [1] { "number is" } else { "numbers are" };
    let message = format!("`<{name}>` is `{}`: {} finite {numbers} wanted", text.trim(), wanted.join(" or "));
    Err(ImportFault::at_node(at, message))
}
