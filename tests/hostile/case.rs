//! The cases of hostile inputs, as files state them.
//!
//! ```text
//! --- what it shows
//! $ check main.mod          the arguments of the command
//! = 1 E0005 E0001           the exit code, and all codes of errors that are printed
//! ~ words                   words that are printed, too
//! @ main.mod                the contents of a file, up to the next line that begins with `@`, `<` or `---`
//! let a = ⟦100000×(⟧        a text that is repeated
//! @10000 f#.mod             so many files, with a number from 0 for `#` and the next one for `#+`, in name and contents
//! <                         the standard input
//! ```
//!
//! In contents `⟦3×let a# = 1;⟧` repeats a text, with a number from 0 for `#`, and `⟦00 ff⟧` stands for bytes. `¶` ends a
//! line within a repeated text, and `⟦⟧` at the end of a line takes its line end away.

/// A hostile input, and how the command ends with it.
pub struct Case {
    pub name: String,
    pub command: String,
    pub exit: i32,
    pub codes: Vec<String>,
    pub says: Vec<String>,
    pub files: Vec<(String, Vec<u8>)>,
    pub input: Vec<u8>,
}

/// Where the lines of contents go.
enum Contents {
    /// To so many files of this name.
    File(usize, String),
    /// To the standard input.
    Input,
}

/// The cases of a text.
pub fn cases(text: &str) -> Vec<Case> {
    let found: Vec<Case> = text.split("\n--- ").skip(1).map(case).collect();
    assert!(!found.is_empty(), "there are cases");
    found
}

fn case(section: &str) -> Case {
    let (name, body) = section.split_once('\n').expect("a case has a body");
    let mut case = Case {
        name: name.to_owned(),
        command: String::new(),
        exit: 0,
        codes: Vec::new(),
        says: Vec::new(),
        files: Vec::new(),
        input: Vec::new(),
    };
    let mut contents: Option<(Contents, String)> = None;
    for line in body.lines() {
        let begins = match line.split_at_checked(1) {
            Some(("@", rest)) => {
                let (count, name) = rest.split_once(' ').expect("a file has a name");
                Some(Contents::File(count.parse().unwrap_or(1), name.to_owned()))
            }
            Some(("<", "")) => Some(Contents::Input),
            _ => None,
        };
        if let Some(next) = begins {
            case.take(contents.replace((next, String::new())));
        } else if let Some((_, text)) = &mut contents {
            text.push_str(line);
            text.push('\n');
        } else {
            case.header(line);
        }
    }
    case.take(contents);
    assert!(!case.command.is_empty(), "{name}: what is run?");
    case
}

impl Case {
    fn header(&mut self, line: &str) {
        let Some((sign, rest)) = line.split_once(' ') else { return assert!(line.is_empty(), "{line}") };
        match sign {
            "$" => self.command = rest.to_owned(),
            "~" => self.says.push(rest.to_owned()),
            "=" => {
                let mut words = rest.split(' ');
                self.exit = words.next().and_then(|code| code.parse().ok()).expect("an exit code");
                self.codes = words.map(str::to_owned).collect();
                self.codes.sort();
            }
            _ => panic!("{}: what is `{line}`?", self.name),
        }
    }

    fn take(&mut self, contents: Option<(Contents, String)>) {
        match contents {
            None => {}
            Some((Contents::Input, text)) => self.input = expanded(&text),
            Some((Contents::File(1, name), text)) => self.files.push((name, expanded(&text))),
            Some((Contents::File(count, name), text)) => {
                let file = |index| (numbered(&name, index), expanded(&numbered(&text, index)));
                self.files.extend((0..count).map(file));
            }
        }
    }
}

/// A text with a number for `#`, and the next one for `#+`.
fn numbered(text: &str, index: usize) -> String {
    text.replace("#+", &(index + 1).to_string()).replace('#', &index.to_string())
}

/// Contents with what their brackets stand for. An empty last line stands between cases, and is none of the contents.
fn expanded(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut rest = if text.ends_with("\n\n") { &text[..text.len() - 1] } else { text };
    while let Some((before, after)) = rest.split_once('⟦') {
        bytes.extend(before.as_bytes());
        let (inside, after) = after.split_once('⟧').expect("a bracket is closed");
        rest = after;
        if inside.is_empty() {
            rest = rest.strip_prefix('\n').unwrap_or(rest);
        } else if let Some((count, body)) = inside.split_once('×') {
            let (count, body) = (count.parse().expect("a number"), body.replace('¶', "\n"));
            match body.contains('#') {
                true => (0..count).for_each(|index| bytes.extend(numbered(&body, index).as_bytes())),
                false => bytes.extend(body.repeat(count).as_bytes()),
            }
        } else {
            let byte = |word| u8::from_str_radix(word, 16).expect("bytes in hexadecimal");
            bytes.extend(inside.split(' ').map(byte));
        }
    }
    bytes.extend(rest.as_bytes());
    bytes
}
