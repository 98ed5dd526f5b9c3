//! Meshes and clouds of points from files of the project, by the ends of their names.

use crate::formats::{CLOUD_FORMATS, Content, Format, FormatFault, MESH_FORMATS};
use crate::geometry::Vec3;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::stop::{Eval, fault};
use crate::interpret::value::Mesh;
use crate::source::{Diagnostic, code};

/// Returns (path, mesh) of the file that the argument `name` names: its path in the project, and the mesh in it.
/// `scale`: the length of one of the file's units, m.
///
/// # Errors
/// A fault where the file can't be read, or its name or text is none of a mesh.
pub(super) fn read(
    interpreter: &mut Interpreter,
    call: &Call,
    name: &str,
    scale: f64,
) -> Eval<(String, Mesh)> {
    let (path, read) = read_as(interpreter, call, name, "mesh", MESH_FORMATS, Format::read_mesh)?;
    let vertices = read.vertices.into_iter().map(|p| Vec3::from(p) * scale).collect();
    Ok((path, Mesh { vertices, faces: read.faces }))
}

/// Returns the points (m) in the file that the argument `name` names; `scale` as in [`read`].
///
/// # Errors
/// A fault where the file can't be read, or its name or text is none of a cloud.
pub(super) fn read_cloud(
    interpreter: &mut Interpreter,
    call: &Call,
    name: &str,
    scale: f64,
) -> Eval<Vec<Vec3>> {
    let (_, read) = read_as(interpreter, call, name, "cloud", CLOUD_FORMATS, Format::read_cloud)?;
    Ok(read.vertices.into_iter().map(|p| Vec3::from(p) * scale).collect())
}

/// Returns the content of a file in one of the formats, by the ending of its name, with its path in the
/// project. `what`: the word for such files.
fn read_as(
    interpreter: &mut Interpreter,
    call: &Call,
    name: &str,
    what: &str,
    formats: &[Format],
    read: fn(&Format, &[u8]) -> Result<Content, FormatFault>,
) -> Eval<(String, Content)> {
    let format = by_name(call, name, what, formats, |format| format.ending)?;
    let (path, bytes) = interpreter.project_file(call, name)?;
    let content = read(format, &bytes).map_err(|why| {
        let message = format!("`{path}` can't be read as {}: {why}", format.name);
        fault(code::CANNOT_READ, call.at(name), message, why.to_string())
    })?;
    interpreter.check_list(content.faces.len().max(content.vertices.len()), call.at(name))?;
    Ok((path, content))
}

/// Returns the format of the file that the argument `name` names, by the ending of its name. `what`: the word for such
/// files; `ending`: that of a format.
///
/// # Errors
/// A fault where no format has this ending.
pub(super) fn by_name<'f, F>(
    call: &Call,
    name: &str,
    what: &str,
    formats: &'f [F],
    ending: fn(&F) -> &'static str,
) -> Eval<&'f F> {
    let file: &str = call.get(name)?;
    let stated = file.rsplit_once('.').map_or_else(String::new, |(_, end)| end.to_ascii_lowercase());
    formats.iter().find(|format| ending(format) == stated).ok_or_else(|| {
        let message = format!("`{file}` is no {what} file by its name");
        let ends: Vec<String> = formats.iter().map(|format| format!("`.{}`", ending(format))).collect();
        let (last, others) = ends.split_last().expect("there are formats");
        Diagnostic::error(code::CANNOT_READ, message)
            .label(call.at(name), format!("not a name of a {what} file"))
            .hint(format!("names of {what} files end in {} or {last}", others.join(", ")))
            .into()
    })
}
