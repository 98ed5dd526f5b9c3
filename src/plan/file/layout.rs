//! The layout of plan files: lines and blanks between the tokens of JSON.

/// The depth up to which containers have a line for each item; deeper ones, such as a segment of a track, stay on
/// one line.
const LINES_DEPTH: usize = 5;

/// Returns compact JSON with a line for each item of the outer containers, so that a person can find an item
/// and two plans can be compared; inner containers stay on the line where they stand.
pub(super) fn laid_out(compact: &str) -> String {
    let mut text = String::with_capacity(compact.len() + compact.len() / 4);
    let (mut depth, mut quoted, mut escaped) = (0, false, false);
    let mut letters = compact.chars().peekable();
    while let Some(letter) = letters.next() {
        if quoted {
            text.push(letter);
            quoted = escaped || letter != '"';
            escaped = !escaped && letter == '\\';
            continue;
        }
        match letter {
            '[' | '{' => {
                depth += 1;
                text.push(letter);
                let empty = letters.peek().is_some_and(|next| matches!(next, ']' | '}'));
                if depth <= LINES_DEPTH && !empty {
                    new_line(&mut text, depth);
                }
            }
            ']' | '}' => {
                depth -= 1;
                let empty = text.ends_with(['[', '{']);
                if depth < LINES_DEPTH && !empty {
                    new_line(&mut text, depth);
                }
                text.push(letter);
            }
            ',' if depth <= LINES_DEPTH => {
                text.push(',');
                new_line(&mut text, depth);
            }
            ',' => text.push_str(", "),
            ':' => text.push_str(": "),
            _ => {
                quoted = letter == '"';
                text.push(letter);
            }
        }
    }
    text.push('\n');
    text
}

fn new_line(text: &mut String, depth: usize) {
    text.push('\n');
    text.extend(std::iter::repeat_n(' ', depth));
}
