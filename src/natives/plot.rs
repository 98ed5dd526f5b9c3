//! Plots: lists of quantities as curves, points and histograms.

use super::Native;
use crate::check::typed::{DefKind, Expr, ExprKind};
use crate::interpret::argument::{Auto, Choice, WordOr, parameters};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::record::{Field, NativeRecord, Record, field_names, read_field};
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::units::Dimension;
use crate::view::plot::{self, Plot, PlotAxis, PlotKind, PlotSeries};
use std::rc::Rc;

/// The built-in `plot`, which makes a diagram of numbers: its key with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[Native::pure(
    "plot",
    parameters![
        y: &Value,
        x: Option<&Value>,
        kind: PlotKind,
        names: &[Value],
        title: &str,
        x_label: Option<&str>,
        y_label: Option<&str>,
        bins: WordOr<Auto, usize>
    ],
    plot_values,
)];

/// The greatest number of bins of a histogram.
const BINS_MAX: usize = 1000;

/// The longest name that is made of the words of an argument, in characters.
const NAME_MAX: usize = 40;

impl Choice for PlotKind {
    const WORDS: &'static [(&'static str, PlotKind)] =
        &[("curve", PlotKind::Curve), ("scatter", PlotKind::Scatter), ("histogram", PlotKind::Histogram)];
}

/// Values in SI units with their dimension; `None` where one is missing or infinite.
type Numbers = (Vec<Option<f64>>, Dimension);

/// Runs `plot(y)`: makes a `Plot` of one list or of several.
///
/// # Errors
/// A fault where a list is empty, all values are missing, an axis mixes dimensions, lists do not pair up, or
/// the bins or names do not fit.
fn plot_values(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let kind: PlotKind = call.get("kind")?;
    let y = lists(call, "y", call.get("y")?)?;
    let x = call.get::<Option<&Value>>("x")?.map(|x| lists(call, "x", x)).transpose()?;
    let bins = bins(call, kind)?;
    if kind == PlotKind::Histogram && x.is_some() {
        return Err(call.refuse("x", "a histogram counts values of `y`, and has no `x`"));
    }
    let dimension = common_dimension(call, "y", &y)?;
    let x_dimension = x.as_ref().map_or(Ok(Dimension::NUMBER), |x| common_dimension(call, "x", x))?;
    let names = names(interpreter, call, y.len())?;
    let series = y.iter().zip(names).enumerate().map(|(i, ((values, _), name))| {
        let xs = match &x {
            Some(lists) if lists.len() == 1 => Some(&lists[0].0),
            Some(lists) => lists.get(i).map(|list| &list.0),
            None => None,
        };
        let points = values.iter().enumerate().map(|(place, value)| {
            let x = xs.map_or(Some(place as f64), |xs| xs.get(place).copied().flatten());
            x.zip(*value).map(|(x, y)| [x, y])
        });
        PlotSeries { name, points: points.collect() }
    });
    let series: Vec<PlotSeries> = series.collect();
    check_lengths(call, &y, x.as_deref())?;
    if series.iter().all(|series| series.points.iter().all(Option::is_none)) {
        return Err(call.refuse("y", "nothing can be drawn: all values are missing or infinite"));
    }
    let label = |argument: &str, label: &str| -> Eval<String> {
        let stated = call.get::<Option<&str>>(label)?.map(str::to_string);
        Ok(stated.or_else(|| interpreter.quantity_name(call.expr(argument)?)).unwrap_or_default())
    };
    let (x_label, y_label) = (label("x", "x_label")?, label("y", "y_label")?);
    let (x, y) = match kind {
        PlotKind::Histogram => {
            let counted = call.get::<Option<&str>>("x_label")?.map_or(y_label, str::to_string);
            let number = call.get::<Option<&str>>("y_label")?.unwrap_or("number").to_string();
            (PlotAxis { label: counted, dimension }, PlotAxis { label: number, dimension: Dimension::NUMBER })
        }
        PlotKind::Curve | PlotKind::Scatter | PlotKind::Front => {
            (PlotAxis { label: x_label, dimension: x_dimension }, PlotAxis { label: y_label, dimension })
        }
    };
    let title = call.get::<&str>("title")?.to_string();
    let plot = Plot { kind, title, x, y, series, bins };
    Ok(Value::Record(Rc::new(Record::Native(Rc::new(PlotValue(plot))))))
}

/// Returns the number of bins that the call states; `None` for `auto`.
///
/// # Errors
/// A fault where the plot is no histogram, or the number is not between 1 and [`BINS_MAX`].
fn bins(call: &Call, kind: PlotKind) -> Eval<Option<usize>> {
    match call.get::<WordOr<Auto, usize>>("bins")? {
        WordOr::Word(Auto) => Ok(None),
        WordOr::Value(_) if kind != PlotKind::Histogram => {
            Err(call.refuse("bins", "only a histogram has bins: `kind: histogram`"))
        }
        WordOr::Value(bins) if (1..=BINS_MAX).contains(&bins) => Ok(Some(bins)),
        WordOr::Value(_) => Err(call.refuse("bins", format!("a histogram has 1 to {BINS_MAX} bins"))),
    }
}

/// Returns the lists of an argument that is one list of quantities or several.
///
/// # Errors
/// A fault where there is no list, or an empty one.
fn lists(call: &Call, argument: &str, value: &Value) -> Eval<Vec<Numbers>> {
    let Value::List(elements) = value else { unreachable!("`check` lets only lists through") };
    let several = elements.iter().any(|element| matches!(element, Value::List(_)));
    let found = match several {
        true => elements.iter().filter_map(numbers).collect(),
        false => Vec::from_iter(numbers(value)),
    };
    if found.is_empty() || found.iter().any(|(values, _)| values.is_empty()) {
        return Err(call.refuse(argument, "an empty list has nothing to draw"));
    }
    Ok(found)
}

/// Returns the values of a list, with the dimension of the first that is not missing; `None` for what is not a list.
fn numbers(list: &Value) -> Option<Numbers> {
    let Value::List(elements) = list else { return None };
    let dimension = elements.iter().find_map(Value::as_dimension).unwrap_or(Dimension::NUMBER);
    Some((elements.iter().map(|x| x.as_number().filter(|x| x.is_finite())).collect(), dimension))
}

/// Returns the dimension of all these lists. Panics if there is none.
///
/// # Errors
/// A fault at `argument` where two differ.
fn common_dimension(call: &Call, argument: &str, lists: &[Numbers]) -> Eval<Dimension> {
    let first = lists[0].1;
    match lists.iter().all(|(_, dimension)| *dimension == first) {
        true => Ok(first),
        false => Err(call.refuse(argument, "one axis shows quantities of one dimension")),
    }
}

/// Checks that the values of the lists pair up: one list of `x` serves all of `y`.
///
/// # Errors
/// A fault where the number of lists, or of values in two of them, differs.
fn check_lengths(call: &Call, y: &[Numbers], x: Option<&[Numbers]>) -> Eval<()> {
    let Some(x) = x else { return Ok(()) };
    if x.len() > 1 && x.len() != y.len() {
        let message = format!("there are {} lists of `y` and {} of `x`", y.len(), x.len());
        return Err(call.refuse("x", message));
    }
    for (i, (values, _)) in y.iter().enumerate() {
        let (wanted, have) = (x[if x.len() == 1 { 0 } else { i }].0.len(), values.len());
        if wanted != have {
            let which = if y.len() == 1 { "`y`".to_string() } else { format!("list {i} of `y`") };
            return Err(call.refuse("y", format!("{which} has {have} values and `x` has {wanted}")));
        }
    }
    Ok(())
}

/// Returns the names of the series: those given, or the words of the arguments; empty where neither gives one.
///
/// # Errors
/// A fault where names are given, and not one for each of the `count` series.
fn names(interpreter: &Interpreter, call: &Call, count: usize) -> Eval<Vec<String>> {
    let given = call.get::<&[Value]>("names")?;
    if !given.is_empty() && given.len() != count {
        let message = format!("`names` wants as many names as lists, {count}, and not {}", given.len());
        return Err(call.refuse("names", message));
    }
    if !given.is_empty() {
        return Ok(given.iter().map(|name| interpreter.show(name)).collect());
    }
    Ok(match call.expr("y").map(|e| &e.kind) {
        Some(ExprKind::List(elements)) if elements.len() == count && count > 1 => {
            elements.iter().map(|e| interpreter.series_name(e).unwrap_or_default()).collect()
        }
        _ => vec![String::new(); count],
    })
}

impl Interpreter<'_> {
    /// Returns the name of the quantity that an expression lists, for an axis: that of a field, of a signal, or
    /// of a value; `None` where the expression names none, or several.
    fn quantity_name(&self, e: &Expr) -> Option<String> {
        match &e.kind {
            ExprKind::Field { field, .. } => Some(field.to_string()),
            ExprKind::Global(def) => Some(self.shared.program.def(*def).name.to_string()),
            ExprKind::Local(_) => Some(self.words_of(e)),
            ExprKind::Comprehension { body, .. } | ExprKind::SetDimension(body) => self.quantity_name(body),
            ExprKind::OrElse { value, .. } => self.quantity_name(value),
            ExprKind::Index { object, .. } => self.quantity_name(object),
            ExprKind::List(elements) => {
                let mut names = elements.iter().map(|e| self.quantity_name(e));
                let first = names.next()??;
                names.all(|name| name.as_ref() == Some(&first)).then_some(first)
            }
            ExprKind::Call { def, args } => {
                let declared = self.shared.program.def(*def);
                let DefKind::Native(native) = &declared.kind else { return None };
                match native.key.as_str() {
                    "Plan.times" => Some("time".into()),
                    "Plan.series" => self.quantity_name(args.get(1)?.as_ref()?),
                    key => Some(key.rsplit('.').next().unwrap_or(key).to_string()),
                }
            }
            _ => None,
        }
    }

    /// Returns the name of one series among several, as it is written; of `p.series(...)` the signal. `None` if
    /// that is longer than [`NAME_MAX`] characters or one line.
    fn series_name(&self, e: &Expr) -> Option<String> {
        if let ExprKind::Call { def, args } = &e.kind
            && let DefKind::Native(native) = &self.shared.program.def(*def).kind
            && native.key.as_str() == "Plan.series"
        {
            return self.series_name(args.get(1)?.as_ref()?);
        }
        let words = self.words_of(e);
        (words.chars().count() <= NAME_MAX && !words.contains('\n')).then_some(words)
    }

    /// Returns an expression as it is written.
    fn words_of(&self, e: &Expr) -> String {
        let text = &self.shared.sources.file(e.span.file).text;
        text.get(e.span.start as usize..e.span.end as usize).unwrap_or_default().to_string()
    }
}

/// The value of the language's type `Plot`: the curves, points or bars of a diagram, without its size.
#[derive(Debug)]
pub struct PlotValue(Plot);

impl PlotValue {
    /// Returns the plot as a small drawing of characters, in several lines of text.
    pub fn text(&self) -> String {
        plot::text(&self.0)
    }

    /// Returns the plot in the form that the renderers read.
    pub(super) fn plot(&self) -> &Plot {
        &self.0
    }
}

impl NativeRecord for PlotValue {
    fn read(&self, field: &str) -> Value {
        read_field(PLOT, &self.0, field)
    }

    fn show(&self) -> String {
        self.0.describe()
    }
}

/// The fields of a `Plot`.
const PLOT: &[Field<Plot>] =
    &[("series", |plot| Value::count(plot.series.len())), ("gaps", |plot| Value::count(plot.gaps()))];

/// Returns the records of this file, each as (name, names of its fields in order).
pub(super) fn records() -> Vec<(&'static str, Vec<&'static str>)> {
    vec![("Plot", field_names(PLOT))]
}
