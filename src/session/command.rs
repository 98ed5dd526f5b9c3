//! The commands of a session and their syntax.

use crate::source::suggest::suggest;

/// A command of a session, with its argument as it was typed, without the blanks around it. `:help` describes each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Command {
    Help,
    Type(String),
    Doc(String),
    Source(String),
    Ports(String),
    What(String),
    Verify(String),
    Load(String),
    Reload,
    Save(String),
    Vars,
    Undo,
    Reset,
    Time(String),
    View(String),
    Quit,
}

/// The commands as (name, argument, description), in the order of `:help`.
pub(crate) const COMMANDS: &[(&str, &str, &str)] = &[
    ("help", "", "this list"),
    ("type", "EXPR", "the type of an expression, which is not evaluated"),
    ("doc", "NAME", "what a name means: signature and documentation; also `?NAME`"),
    ("source", "NAME", "how a name is declared"),
    ("ports", "EXPR", "the free ports of a robot"),
    ("what", "EXPR", "what the library can do with a robot: configurations that embed"),
    ("verify", "EXPR", "the judge's report on a behaviour, a plan or a robot"),
    ("view", "EXPR", "draw it on a page, and open that"),
    ("time", "EXPR", "evaluate, and say how long it took"),
    ("vars", "", "what has been declared"),
    ("load", "FILE", "take in what a file of the project declares"),
    ("reload", "", "read all files again, and say what changed"),
    ("save", "FILE", "write what was entered as a program, formatted"),
    ("undo", "", "take back the last entry"),
    ("reset", "", "forget everything"),
    ("quit", "", "leave; Ctrl-D does, too"),
];

/// Parses a line as a command, which begins with `:` or `?`. `None` if the line does not.
///
/// # Errors
/// A message for an unknown command, and for one with an argument too many or too few.
pub(crate) fn parse(line: &str) -> Option<Result<Command, String>> {
    let line = line.trim();
    if let Some(name) = line.strip_prefix('?') {
        let name = name.trim().to_owned();
        return Some(Ok(if name.is_empty() { Command::Help } else { Command::Doc(name) }));
    }
    let rest = line.strip_prefix(':')?;
    let (word, rest) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
    Some(command(word, rest.trim()))
}

/// Parses a line as a command that is written as a word of its own, as other sessions have it: `quit`, `exit`, `help`
/// and `help NAME`, with or without `( )`. Returns (word, command); `None` for any other line. A program may declare
/// these names: then the caller does not ask.
pub(crate) fn parse_word(line: &str) -> Option<(&str, Command)> {
    let line = line.trim();
    let (word, rest) = line.split_once([' ', '(']).unwrap_or((line, ""));
    let rest = rest.trim_matches([' ', '(', ')']);
    let command = match (word, rest) {
        ("quit" | "exit", "") => Command::Quit,
        ("help", "") => Command::Help,
        ("help", name) if name.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '.')) => {
            Command::Doc(name.to_owned())
        }
        _ => return None,
    };
    Some((word, command))
}

/// Returns the command with this name or unique prefix of a name, with the argument `rest`.
///
/// # Errors
/// A message if there is none, or if the argument does not fit.
fn command(word: &str, rest: &str) -> Result<Command, String> {
    // A prefix is enough if it is unique.
    let of_word = |name: &str| !word.is_empty() && name.starts_with(word);
    let mut meant = COMMANDS.iter().filter(|(name, ..)| *name == word);
    let found = meant.next().or_else(|| {
        let mut beginning = COMMANDS.iter().filter(|(name, ..)| of_word(name));
        beginning.next().filter(|_| beginning.next().is_none())
    });
    let Some((name, wants, _)) = found else {
        let near = suggest(word, COMMANDS.iter().map(|(name, ..)| *name));
        let near = near.map_or_else(|| "`:help` lists them".to_owned(), |near| format!("`:{near}`?"));
        return Err(format!("there is no command `:{word}`; {near}"));
    };
    if wants.is_empty() != rest.is_empty() {
        let wants = if wants.is_empty() { String::new() } else { format!(" {wants}") };
        return Err(format!("`:{name}` is written `:{name}{wants}`"));
    }
    let rest = rest.to_owned();
    Ok(match *name {
        "help" => Command::Help,
        "type" => Command::Type(rest),
        "doc" => Command::Doc(rest),
        "source" => Command::Source(rest),
        "ports" => Command::Ports(rest),
        "what" => Command::What(rest),
        "verify" => Command::Verify(rest),
        "view" => Command::View(rest),
        "time" => Command::Time(rest),
        "vars" => Command::Vars,
        "load" => Command::Load(unquoted(&rest)),
        "reload" => Command::Reload,
        "save" => Command::Save(unquoted(&rest)),
        "undo" => Command::Undo,
        "reset" => Command::Reset,
        _ => Command::Quit,
    })
}

/// Returns a path without the quotes that may be around it, as in a program.
fn unquoted(path: &str) -> String {
    path.strip_prefix('"').and_then(|p| p.strip_suffix('"')).unwrap_or(path).to_owned()
}

/// Returns the text that the command `:help` prints: all commands with their descriptions.
pub(crate) fn help() -> String {
    let mut out =
        String::from("Type an expression, a declaration or a statement of the language; or one of\n\n");
    for (name, wants, does) in COMMANDS {
        let typed = format!(":{name} {wants}");
        out.push_str(&format!("  {:<14} {does}\n", typed.trim_end()));
    }
    out.push_str(
        "\n`_` is the last value. Tab completes, Ctrl-R searches what was typed before, Ctrl-C ends what\n\
         takes too long. An entry goes on over several lines as long as something is open.\n",
    );
    out
}
