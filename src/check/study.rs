//! Studies: axes, samplers, and the record that their rows are.

use super::checker::{Checker, DefItem};
use super::describe::dimension_words;
use super::expr::{Role, error_expr, expr_of};
use super::scope::Scope;
use super::typed::{DefId, DefKind, Expr, ExprKind, SamplerDef, StudyAxis, StudyDef};
use super::types::Type;
use crate::source::suggest::suggest;
use crate::source::{Diagnostic, Span, Symbol, code};
use crate::syntax::ast;
use std::sync::Arc;

/// The samplers, by name.
const SAMPLERS: &[&str] = &["grid", "sobol", "random", "cmaes"];
/// The hint that shows the form of a study's settings, by sampler.
const FORMS: &[(&str, &str)] = &[
    ("grid", "write `grid(amplitude: 9)`: the number of values of each axis that is a range"),
    ("sobol", "write `sobol(256)`: the number of points"),
    ("random", "write `random(256)`: the number of points"),
    ("cmaes", "write `cmaes(maximise: speed, budget: 200)`, or `minimise:`"),
];
/// The greatest number of axes of one study.
const AXES_MAX: usize = 21;
/// The greatest depth of records within the record of a row.
const LEVELS_MAX: usize = 8;

impl<'a> Checker<'a> {
    /// Returns the typed expression of a study used as a value, by its name at `span`; an error node if its rows could
    /// not be understood.
    pub(super) fn study_value(&mut self, id: DefId, span: Span) -> Expr {
        match self.inferred_type(id, Some(span)) {
            Type::Error => error_expr(span),
            ty => expr_of(span, ty, ExprKind::Global(id)),
        }
    }

    /// Checks a `study`.
    pub(super) fn check_study(&mut self, id: DefId, study: &'a ast::Study) -> DefKind {
        let mut scope = Scope::new(self.def(id).file, None);
        let axes: Vec<StudyAxis> = study.axes.iter().map(|axis| self.study_axis(&mut scope, axis)).collect();
        let each: Vec<StudyAxis> = study.each.iter().map(|axis| self.each_axis(&mut scope, axis)).collect();
        if axes.len() > AXES_MAX {
            let message = format!("a study has at most {AXES_MAX} axes, besides those after `each`");
            self.report(
                Diagnostic::error(code::BAD_STUDY, message).label(axes[AXES_MAX].span, "one too many"),
            );
        }
        let mut known: Vec<(Symbol, Span)> = Vec::new();
        for axis in axes.iter().chain(&each) {
            if let Some((_, first)) = known.iter().find(|(name, _)| *name == axis.name) {
                self.declared_twice(axis.name, *first, axis.span);
            }
            known.push((axis.name, axis.span));
            self.lint_snake(axis.name, axis.span, "axes");
        }
        let mut inner = Scope::new(self.def(id).file, None);
        for axis in axes.iter().chain(&each) {
            inner.bind(axis.name, axis.ty.clone());
        }
        let body = self.expr(&mut inner, &study.body, None);
        let all: Vec<&StudyAxis> = axes.iter().chain(&each).collect();
        let row = self.study_row(id, &body, &all);
        let sampler = self.sampler(&mut scope, study, &axes, row);
        let ty = row.map_or(Type::Error, |row| Type::Study(Arc::new(Type::Record(row))));
        self.def_mut(id).inferred.get_or_insert(ty);
        let frame = scope.frame().max(inner.frame());
        let end = study.settings.last().map_or(study.sampler.span, |arg| arg.value.span);
        let sampler_span = study.sampler.span.to(self.closing(end));
        DefKind::Study(StudyDef { axes, each, sampler, sampler_span, body, row, frame })
    }

    /// Returns the span from `last`, the last setting of a sampler, to the parenthesis that closes the settings.
    fn closing(&self, last: Span) -> Span {
        let text = &self.sources.file(last.file).text;
        let rest = text.get(last.end as usize..).unwrap_or_default();
        let end = rest.find(')').map_or(last.end, |at| last.end + at as u32 + 1);
        Span { end, ..last }
    }

    /// Checks an axis that the sampler chooses: a list of plain values, a range of whole numbers or of quantities.
    fn study_axis(&mut self, scope: &mut Scope, axis: &'a ast::StudyAxis) -> StudyAxis {
        let domain = self.expr(scope, &axis.domain, None);
        let ty = match &domain.ty {
            Type::Range(of) => (**of).clone(),
            _ => self.axis_element(&domain, "an axis has the values of a list or a range"),
        };
        StudyAxis { name: axis.name.text, span: axis.name.span, ty, domain }
    }

    /// Checks an axis after `each`: a list of plain values, or a range of whole numbers.
    fn each_axis(&mut self, scope: &mut Scope, axis: &'a ast::StudyAxis) -> StudyAxis {
        let domain = self.expr(scope, &axis.domain, None);
        let ty = match &domain.ty {
            Type::Range(of) if **of == Type::Int => Type::Int,
            _ => self.axis_element(&domain, "`each` goes through a list or a range of whole numbers"),
        };
        StudyAxis { name: axis.name.text, span: axis.name.span, ty, domain }
    }

    /// Returns the type of an element of a list of plain values; reports another domain.
    fn axis_element(&mut self, domain: &Expr, wants: &str) -> Type {
        match &domain.ty {
            Type::Error => return Type::Error,
            Type::List(of) if **of == Type::Error => return Type::Error,
            Type::List(of) if is_plain(of) => return (**of).clone(),
            _ => {}
        }
        let words = self.words(&domain.ty);
        self.report(
            Diagnostic::error(code::TYPE_MISMATCH, format!("{wants}; this is {words}"))
                .label(domain.span, format!("this is {words}"))
                .hint(
                    "`n in [2, 4, 8]`, `i in 0..4`, `amplitude in 8deg..40deg`; of other values number them: \
                    `i in 0..3`, and `list[i]` in the body",
                ),
        );
        Type::Error
    }

    /// Returns the record that the body of a study gives; reports one that is no record of plain values, or that has a
    /// field of the name of an axis but of another type.
    fn study_row(&mut self, id: DefId, body: &Expr, axes: &[&StudyAxis]) -> Option<DefId> {
        let row = match body.ty {
            Type::Error => return None,
            Type::Record(row) if matches!(self.def(row).item, DefItem::Record(_)) => row,
            _ => {
                let (name, words) = (self.def(id).name, self.words(&body.ty));
                let message = format!("the rows of `{name}` are records; this is {words}");
                let diagnostic = Diagnostic::error(code::BAD_STUDY, message)
                    .label(body.span, format!("this is {words}"))
                    .hint(
                        "declare the columns, `record Row { speed: Speed }`, and end with `Row(speed: ...)`",
                    );
                self.report(diagnostic);
                return None;
            }
        };
        if let Some((path, ty)) = self.unplain_field(row, 0) {
            let (name, words) = (self.def(row).name, self.words(&ty));
            let message = format!("the field `{path}` of `{name}`, {words}, is no column of a table");
            let diagnostic = Diagnostic::error(code::BAD_STUDY, message)
                .label(body.span, "this is a row of the study")
                .label(self.def(row).span, "declared here")
                .hint(
                    "a column holds quantities, whole numbers, texts, words, vectors, or `true` and `false`",
                );
            self.report(diagnostic);
            return None;
        }
        let signature = self.signature(row);
        for param in &signature.params {
            if let Some(axis) = axes.iter().find(|axis| axis.name == param.name)
                && axis.ty != param.ty
                && !axis.ty.is_error()
            {
                let message = format!("the table would have two columns `{}`", axis.name);
                let diagnostic = Diagnostic::error(code::BAD_STUDY, message)
                    .label(axis.span, format!("an axis has this name, {}", self.words(&axis.ty)))
                    .label(param.span, format!("and a field of the row, {}", self.words(&param.ty)))
                    .hint("a field that repeats an axis has its type; give another field another name");
                self.report(diagnostic);
                return None;
            }
        }
        Some(row)
    }

    /// Returns the first field of a record that no columns of a table hold, as (path, type); `None` if there is none.
    fn unplain_field(&mut self, record: DefId, level: usize) -> Option<(String, Type)> {
        let signature = self.signature(record);
        for param in &signature.params {
            match &param.ty {
                Type::Record(inner)
                    if level < LEVELS_MAX && matches!(self.def(*inner).item, DefItem::Record(_)) =>
                {
                    if let Some((path, ty)) = self.unplain_field(*inner, level + 1) {
                        return Some((format!("{}.{path}", param.name), ty));
                    }
                }
                Type::Vec3(_) | Type::Error => {}
                Type::Optional(inner) if is_plain(inner) => {}
                ty if is_plain(ty) => {}
                ty => return Some((param.name.to_string(), ty.clone())),
            }
        }
        None
    }

    /// Checks the sampler with its settings. `row`: the record of the rows.
    fn sampler(
        &mut self,
        scope: &mut Scope,
        study: &'a ast::Study,
        axes: &[StudyAxis],
        row: Option<DefId>,
    ) -> SamplerDef {
        match study.sampler.text.as_str() {
            "grid" => self.grid(scope, study, axes),
            "sobol" => self.count_of(scope, study).map_or(SamplerDef::Error, SamplerDef::Sobol),
            "random" => self.count_of(scope, study).map_or(SamplerDef::Error, SamplerDef::Random),
            "cmaes" => self.cmaes(scope, study, row),
            other => {
                let message = format!("`{other}` is no sampler");
                let mut diagnostic = Diagnostic::error(code::BAD_STUDY, message)
                    .label(study.sampler.span, format!("one of {} is wanted", SAMPLERS.join(", ")));
                if let Some(near) = suggest(other, SAMPLERS.iter().copied()) {
                    diagnostic = diagnostic.hint(format!("`{near}`?"));
                }
                self.report(diagnostic);
                SamplerDef::Error
            }
        }
    }

    /// Reports settings that the sampler of a study does not take.
    fn bad_settings(&mut self, study: &ast::Study, span: Span, why: String) {
        let form = FORMS.iter().find(|(name, _)| study.sampler.text == *name).map_or("", |(_, form)| form);
        self.report(Diagnostic::error(code::ARGUMENTS, why).label(span, "this does not fit").hint(form));
    }

    /// Checks the number of points, the only setting of `sobol` and `random`.
    fn count_of(&mut self, scope: &mut Scope, study: &'a ast::Study) -> Option<Expr> {
        match study.settings.as_slice() {
            [arg] if arg.name.is_none_or(|name| name.text == "count") => {
                Some(self.expect(scope, &arg.value, &Type::Int, Role::Place("the number of points")))
            }
            settings => {
                let span = settings.first().map_or(study.sampler.span, |arg| arg.value.span);
                let message =
                    format!("`{}` takes the number of points, and nothing else", study.sampler.text);
                self.bad_settings(study, span, message);
                None
            }
        }
    }

    /// Checks the settings of `grid`: a number of values for each axis that is a range of quantities.
    fn grid(&mut self, scope: &mut Scope, study: &'a ast::Study, axes: &[StudyAxis]) -> SamplerDef {
        let is_range = |axis: &StudyAxis| matches!(&axis.domain.ty, Type::Range(of) if **of != Type::Int);
        let mut counts: Vec<(usize, Expr)> = Vec::new();
        for arg in &study.settings {
            let index = arg.name.and_then(|name| axes.iter().position(|axis| axis.name == name.text));
            match index {
                Some(index) if counts.iter().any(|(known, _)| *known == index) => {
                    self.bad_settings(
                        study,
                        arg.value.span,
                        format!("`{}` is given twice", axes[index].name),
                    );
                }
                Some(index) if is_range(&axes[index]) || axes[index].ty.is_error() => {
                    let role = Role::Param(axes[index].name);
                    counts.push((index, self.expect(scope, &arg.value, &Type::Int, role)));
                }
                Some(index) => {
                    let message = format!("`{}` has its own values; a grid takes them all", axes[index].name);
                    self.bad_settings(study, arg.value.span, message);
                }
                None => {
                    let message = match arg.name {
                        Some(name) => format!("the study has no axis `{}`", name.text),
                        None => "`grid` takes a number of values by the name of its axis".to_owned(),
                    };
                    self.bad_settings(study, arg.name.map_or(arg.value.span, |name| name.span), message);
                }
            }
        }
        let given = |index: usize| counts.iter().any(|(known, _)| *known == index);
        let missing = axes.iter().enumerate().find(|(index, axis)| is_range(axis) && !given(*index));
        if let Some((_, axis)) = missing {
            let message = format!("`grid` needs the number of values of `{}`", axis.name);
            self.bad_settings(study, study.sampler.span, message);
        }
        SamplerDef::Grid(counts)
    }

    /// Checks the settings of `cmaes`: the field that is sought, and the budget.
    fn cmaes(&mut self, scope: &mut Scope, study: &'a ast::Study, row: Option<DefId>) -> SamplerDef {
        let (mut goal, mut budget) = (None, None);
        for arg in &study.settings {
            match arg.name.map(|name| name.text.as_str()) {
                Some(word @ ("maximise" | "minimise")) if goal.is_none() => {
                    goal = Some((word == "maximise", &arg.value));
                }
                Some("budget") if budget.is_none() => {
                    budget = Some(self.expect(scope, &arg.value, &Type::Int, Role::Place("the budget")));
                }
                _ => {
                    let span = arg.name.map_or(arg.value.span, |name| name.span);
                    let message = "`cmaes` takes what is sought, and the budget, each once".to_owned();
                    self.bad_settings(study, span, message);
                    return SamplerDef::Error;
                }
            }
        }
        let (Some((maximise, field)), Some(budget)) = (goal, budget) else {
            let message = "`cmaes` needs what is sought, and the budget".to_owned();
            self.bad_settings(study, study.sampler.span, message);
            return SamplerDef::Error;
        };
        let Some(row) = row else { return SamplerDef::Error };
        match self.objective(row, field) {
            Some(objective) => SamplerDef::Cmaes { objective, maximise, budget },
            None => SamplerDef::Error,
        }
    }

    /// Returns the field of the row that a search seeks, by its index; reports a name that is no field, or one that is
    /// no quantity.
    fn objective(&mut self, row: DefId, field: &ast::Expr) -> Option<usize> {
        let signature = self.signature(row);
        let named = match &field.kind {
            ast::ExprKind::Name(name) => Some(*name),
            _ => None,
        };
        let found = named.and_then(|name| signature.params.iter().position(|param| param.name == name));
        let Some(index) = found else {
            let message = format!("a field of `{}` is sought, by its name", self.def(row).name);
            let names: Vec<&str> = signature.params.iter().map(|param| param.name.as_str()).collect();
            let mut diagnostic = Diagnostic::error(code::UNKNOWN_MEMBER, message)
                .label(field.span, format!("one of {} is wanted", names.join(", ")));
            if let Some(near) = named.and_then(|name| suggest(name.as_str(), names)) {
                diagnostic = diagnostic.hint(format!("`{near}`?"));
            }
            self.report(diagnostic);
            return None;
        };
        let param = &signature.params[index];
        if param.ty.dimension().is_none() && !param.ty.is_error() {
            let words = self.words(&param.ty);
            let message = format!("the best of `{}` can't be told: it is {words}", param.name);
            let wanted = dimension_words(crate::units::Dimension::NUMBER);
            let diagnostic = Diagnostic::error(code::TYPE_MISMATCH, message)
                .label(field.span, format!("{wanted} or another quantity is wanted"));
            self.report(diagnostic);
            return None;
        }
        Some(index)
    }
}

/// Returns true for the types whose values fit into one cell of a table.
fn is_plain(ty: &Type) -> bool {
    match ty {
        Type::Quantity(_) | Type::Int | Type::Bool | Type::Text | Type::Error => true,
        Type::Choice(choice) => choice.types.iter().all(is_plain),
        _ => false,
    }
}
