//! The style of elements: attributes, rules of a style sheet, and the `style` attribute, the last before the first; and
//! the style that elements take over from the groups around them.

use super::Unread;
use super::numbers::{Numbers, shown};
use roxmltree::Node;
use std::collections::BTreeMap;

/// The properties that decide how a line is drawn.
const PROPERTIES: &[&str] = &["stroke", "stroke-opacity", "opacity", "display", "visibility", "transform"];

/// The remedy of a style sheet that can't be read.
const MEND: &str =
    "rules for `.class`, `#id`, an element or `*` are read; give the lines their `stroke` themselves";

/// A style sheet: the values of properties by selector.
#[derive(Default)]
pub(super) struct StyleSheet<'s> {
    /// The number of the declaration, from 0, and the value of a property, by the selector and the property.
    values: BTreeMap<(&'s str, &'static str), (usize, &'s str)>,
}

/// The style with which lines are drawn.
#[derive(Clone, Debug)]
pub(super) struct Style<'a> {
    /// The paint of the stroke.
    stroke: Option<&'a str>,
    /// The opacity of the stroke alone.
    stroke_opacity: f64,
    /// The opacity of the element and the groups around it.
    opacity: f64,
    /// True if it is to be seen.
    visible: bool,
}

impl Default for Style<'_> {
    fn default() -> Self {
        Style { stroke: None, stroke_opacity: 1.0, opacity: 1.0, visible: true }
    }
}

/// Returns the text of a style sheet without its comments.
pub(super) fn without_comments(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, inside)) = rest.split_once("/*") {
        plain.push_str(before);
        plain.push(' ');
        rest = inside.split_once("*/").map_or("", |(_, after)| after);
    }
    plain + rest
}

impl<'s> StyleSheet<'s> {
    /// Reads a style sheet without comments.
    ///
    /// # Errors
    /// The reason why a rule that concerns strokes can't be read.
    pub(super) fn read(text: &'s str) -> Result<StyleSheet<'s>, Unread> {
        let mut sheet = StyleSheet::default();
        let mut rest = text.trim_start();
        let mut count = 0;
        while !rest.is_empty() {
            let head = rest.find(['{', ';']).unwrap_or(rest.len());
            if rest.starts_with('@') {
                // A statement ends with a semicolon; a block would hold rules of its own.
                if !rest[head..].starts_with(';') {
                    return Err(Unread::new(format!("the style sheet has `{}`", shown(rest)), MEND));
                }
                rest = rest[head + 1..].trim_start();
                continue;
            }
            let unread =
                || Unread::new(format!("the style sheet's rule `{}` is not read", shown(rest)), MEND);
            let (selectors, after) = rest.split_once('{').ok_or_else(unread)?;
            let (body, after) = after.split_once('}').ok_or_else(unread)?;
            for (property, value) in declarations(body) {
                for selector in selectors.split(',').map(str::trim) {
                    if !is_simple(selector) {
                        return Err(unread());
                    }
                    count += 1;
                    sheet.values.insert((selector, property), (count, value));
                }
            }
            rest = after.trim_start();
        }
        Ok(sheet)
    }

    /// Returns the number and the value of a declaration of a selector.
    fn declared(&self, selector: &str, property: &'static str) -> Option<(usize, &'s str)> {
        // The key lives no longer than the selector.
        let values: &BTreeMap<(&str, &'static str), (usize, &'s str)> = &self.values;
        values.get(&(selector, property)).copied()
    }

    /// Returns the value of a property for an element, by the most specific rule, and the last of these.
    fn value(&self, node: Node, property: &'static str) -> Option<&'s str> {
        let of = |selector: &str| self.declared(selector, property);
        if let Some((_, value)) = node.attribute("id").and_then(|id| of(&format!("#{id}"))) {
            return Some(value);
        }
        let classes = node.attribute("class").unwrap_or("").split_ascii_whitespace();
        let by_class = classes.filter_map(|class| of(&format!(".{class}"))).max_by_key(|(at, _)| *at);
        by_class.or_else(|| of(node.tag_name().name())).or_else(|| of("*")).map(|(_, value)| value)
    }
}

/// Returns true if a selector names a class, an identity, an element, or all.
fn is_simple(selector: &str) -> bool {
    let name = selector.strip_prefix(['.', '#']).unwrap_or(selector);
    let part = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    selector == "*" || !name.is_empty() && name.chars().all(part)
}

/// Returns the declarations of a rule or a `style` attribute that decide how a line is drawn.
fn declarations(text: &str) -> impl Iterator<Item = (&'static str, &str)> {
    text.split(';').filter_map(|declaration| {
        let (name, value) = declaration.split_once(':')?;
        let property = PROPERTIES.iter().find(|property| **property == name.trim())?;
        let value = value.trim();
        Some((*property, value.strip_suffix("!important").unwrap_or(value).trim()))
    })
}

impl<'a> Style<'a> {
    /// Returns the style of an element within others of this style; `None` if it is not drawn, nor is its content.
    ///
    /// # Errors
    /// The reason why a value can't be read.
    pub(super) fn within<'d: 'a>(
        &self,
        node: Node<'a, 'd>,
        sheet: &StyleSheet<'a>,
    ) -> Result<Option<Style<'a>>, Unread> {
        let own = node.attribute("style").unwrap_or("");
        let stated = |property: &'static str| {
            let attribute = || node.attribute(property);
            let own = declarations(own).filter(|(name, _)| *name == property).last().map(|(_, value)| value);
            let value = own.or_else(|| sheet.value(node, property));
            // Of a transformation the attribute is read elsewhere.
            let value = if property == "transform" { value } else { value.or_else(attribute) };
            value.map(str::trim).filter(|value| *value != "inherit")
        };
        if stated("display") == Some("none") {
            return Ok(None);
        }
        if let Some(value) = stated("transform").filter(|value| *value != "none") {
            let mend = "state it as the attribute `transform`, in degrees and without units";
            return Err(Unread::new(format!("the style has the transformation `{}`", shown(value)), mend));
        }
        let visible = stated("visibility").map_or(self.visible, |value| value == "visible");
        let part =
            |property: &'static str| stated(property).map(|value| opacity(property, value)).transpose();
        Ok(Some(Style {
            stroke: stated("stroke").or(self.stroke),
            stroke_opacity: part("stroke-opacity")?.unwrap_or(self.stroke_opacity),
            opacity: part("opacity")?.unwrap_or(1.0) * self.opacity,
            visible,
        }))
    }

    /// Returns the paint of the stroke; `None` where lines are not to be seen.
    pub(super) fn paint(&self) -> Option<&'a str> {
        self.stroke.filter(|paint| self.visible && !["none", "transparent"].contains(paint))
    }

    /// Returns the opacity of the stroke, 0 to 1.
    pub(super) fn opacity(&self) -> f64 {
        self.stroke_opacity * self.opacity
    }
}

/// Returns an opacity from 0 to 1, which may be stated in percent.
///
/// # Errors
/// The reason why it is none.
fn opacity(property: &str, value: &str) -> Result<f64, Unread> {
    let plain = value.strip_suffix('%');
    let mut numbers = Numbers::of(plain.unwrap_or(value));
    match numbers.number() {
        Ok(number) if numbers.ended() => {
            Ok((number / if plain.is_some() { 100.0 } else { 1.0 }).clamp(0.0, 1.0))
        }
        Ok(_) | Err(_) => {
            let found = format!("`{property}` is `{}`", shown(value));
            Err(Unread::new(found, "an opacity is a number from 0 to 1: the fold angle by 180 degrees"))
        }
    }
}
