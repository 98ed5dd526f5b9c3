//! The tree of a file as text: one line for each item, in the manner of Lisp.

use modl::syntax::ast::*;

pub fn tree(file: &File) -> Vec<String> {
    file.items.iter().map(item).collect()
}

fn item(item: &Item) -> String {
    let text = match &item.kind {
        ItemKind::Use(u) => use_item(u),
        ItemKind::Let(l) => let_item(l),
        ItemKind::Fn(f) => {
            let type_params = type_params(&f.type_params);
            let params = params(&f.params);
            format!("(fn {}{type_params}{params}{} {})", f.name.text, result(&f.result), expr(&f.body))
        }
        ItemKind::Record(r) => {
            let field = |(p, doc): (&Param, &Option<String>)| format!(" {}", documented(doc, param(p)));
            format!("(record {}{})", r.name.text, r.fields.iter().zip(&r.docs).map(field).collect::<String>())
        }
        ItemKind::ExternFn(f) => extern_fn(f),
        ItemKind::ExternType(t) => extern_type(t),
        ItemKind::Connector(c) => {
            format!("(connector {}{})", c.name.text, each(&c.clauses, connector_clause))
        }
        ItemKind::Module(m) => {
            format!("(module {}{}{})", m.name.text, params(&m.params), each(&m.clauses, module_clause))
        }
        ItemKind::Facts(f) => format!("({} {})", f.family.word(), facts(f)),
        ItemKind::Config(c) => config(c),
        ItemKind::Lattice(l) => {
            format!("(lattice {}{} of {} {})", l.name.text, params(&l.params), names(&l.of), expr(&l.value))
        }
        ItemKind::Truss(t) => {
            let body = match &t.body {
                TrussBody::Value(value) => format!(" {}", expr(value)),
                TrussBody::Clauses(clauses) => each(clauses, truss_clause),
            };
            format!("(truss {}{} of {}{body})", t.name.text, params(&t.params), names(&t.of))
        }
        ItemKind::Study(s) => study(s),
        ItemKind::Test(t) => format!("(test {:?}{})", t.name, each(&t.body, statement)),
        ItemKind::Statement(s) => statement(s),
        ItemKind::Error => "ERROR".into(),
    };
    documented(&item.doc, text)
}

fn documented(doc: &Option<String>, text: String) -> String {
    doc.as_ref().map_or(text.clone(), |doc| format!("(doc {doc:?} {text})"))
}

fn each<T>(list: &[T], show: impl std::ops::Fn(&T) -> String) -> String {
    list.iter().map(|one| format!(" {}", show(one))).collect()
}

fn optional<T>(value: &Option<T>, word: &str, show: impl std::ops::Fn(&T) -> String) -> String {
    value.as_ref().map_or(String::new(), |value| format!(" {word}{}", show(value)))
}

fn names(names: &[Name]) -> String {
    names.iter().map(|name| name.text.as_str()).collect::<Vec<_>>().join(".")
}

fn use_item(u: &Use) -> String {
    let source = match &u.source {
        UseSource::Path(path) => names(path),
        UseSource::File { path, .. } => format!("{path:?}"),
    };
    let name = |n: &UseName| {
        format!("{}{}", n.name.text, n.rename.map_or(String::new(), |rename| format!(":{}", rename.text)))
    };
    let imported = u.names.as_ref().map_or(String::new(), |names| format!(" ({})", each(names, name).trim()));
    format!("(use {source}{imported})")
}

fn let_item(l: &Let) -> String {
    format!("(let {}{} {})", l.name.text, optional(&l.ty, ":", ty), expr(&l.value))
}

fn params(params: &[Param]) -> String {
    if params.is_empty() { String::new() } else { format!(" ({})", each(params, param).trim()) }
}

fn param(p: &Param) -> String {
    let many = if p.variadic { "..." } else { "" };
    format!("{}:{}{many}{}", p.name.text, ty(&p.ty), optional(&p.default, "=", expr).replace(' ', ""))
}

fn result(result: &Option<TypeExpr>) -> String {
    optional(result, "->", ty)
}

fn type_params(params: &[TypeParam]) -> String {
    let type_param = |p: &TypeParam| match p.bound {
        Some(bound) => format!("{}:{}", p.name.text, bound.text),
        None => p.name.text.to_string(),
    };
    let listed = each(params, type_param);
    if listed.is_empty() { listed } else { format!(" <{}>", listed.trim()) }
}

fn extern_fn(f: &ExternFn) -> String {
    let type_params = type_params(&f.type_params);
    format!("(extern-fn {}{type_params}{}{})", f.name.text, params(&f.params), result(&f.result))
}

fn extern_type(t: &ExternType) -> String {
    let is = optional(&t.is, "is:", |is| is.text.to_string());
    let field = |f: &ExternField| documented(&f.doc, format!("({} {})", f.name.text, ty(&f.ty)));
    let method = |(doc, f): &(Option<String>, ExternFn)| documented(doc, extern_fn(f));
    format!("(extern-type {}{is}{}{})", t.name.text, each(&t.fields, field), each(&t.methods, method))
}

fn ty(t: &TypeExpr) -> String {
    match &t.kind {
        TypeKind::Named { path, args } if args.is_empty() => names(path),
        TypeKind::Named { path, args } => format!("{}<{}>", names(path), each(args, ty).trim()),
        TypeKind::Quantity(u) => format!("<{}>", unit(u)),
        TypeKind::Optional(t) => format!("{}?", ty(t)),
        TypeKind::Fn { params, result } => format!("fn({})->{}", each(params, ty).trim(), ty(result)),
        TypeKind::Choice(choices) => choices.iter().map(ty).collect::<Vec<_>>().join("|"),
        TypeKind::Error => "ERROR".into(),
    }
}

fn unit(u: &UnitExpr) -> String {
    let factor = |(name, power): &(Name, i32)| match power {
        1 => name.text.to_string(),
        power => format!("{}^{power}", name.text),
    };
    u.factors.iter().map(factor).collect::<Vec<_>>().join("*")
}

fn connector_clause(clause: &ConnectorClause) -> String {
    match clause {
        ConnectorClause::Mates(to) => format!("(mates{})", each(to, |name| name.text.to_string())),
        ConnectorClause::Turns(turns) => format!("(turns {})", expr(turns)),
        ConnectorClause::Holds(load) => format!("(holds {})", expr(load)),
        ConnectorClause::Capture { distance, more, .. } => {
            format!("(capture {}{})", expr(distance), each(more, expr))
        }
        ConnectorClause::Hinge { args, .. } => format!("(hinge{})", each(args, arg)),
        ConnectorClause::Snap => "(snap)".into(),
        ConnectorClause::Error => "ERROR".into(),
    }
}

fn facts(f: &Facts) -> String {
    let fact = |(name, value): &(Name, Expr)| format!("({} {})", name.text, expr(value));
    format!("{}{}{}", f.name.text, params(&f.params), each(&f.facts, fact))
}

fn module_clause(clause: &ModuleClause) -> String {
    let text = match &clause.kind {
        ModuleClauseKind::Mass(value) => format!("(mass {})", expr(value)),
        ModuleClauseKind::Touch(value) => format!("(touch {})", expr(value)),
        ModuleClauseKind::Contact(value) => format!("(contact {})", expr(value)),
        ModuleClauseKind::Link { name, shape, collides, at } => format!(
            "(link {} {}{}{})",
            name.text,
            expr(shape),
            optional(collides, "collides:", expr),
            optional(at, "", placement)
        ),
        ModuleClauseKind::Joint { name, parent, child, kind, at } => format!(
            "(joint {} {}->{} {}{})",
            name.text,
            parent.text,
            child.text,
            expr(kind),
            optional(at, "", placement)
        ),
        ModuleClauseKind::Mimic { name, value } => format!("(mimic {} {})", name.text, expr(value)),
        ModuleClauseKind::Port(port) => module_port(port),
        ModuleClauseKind::Motor { name, value, args } => {
            format!("(motor {} {}{})", name.text, expr(value), each(args, arg))
        }
        ModuleClauseKind::Touching(a, b) => format!("(touching {} {})", a.text, b.text),
        ModuleClauseKind::Alias { name, target } => format!("(alias {} {})", name.text, target.text),
        ModuleClauseKind::Let(l) => let_item(l),
        ModuleClauseKind::Require(r) => require(r),
        ModuleClauseKind::If { condition, then, otherwise } => {
            branch(condition, then, otherwise, module_clause)
        }
        ModuleClauseKind::For { binder, iterable, body } => looped(binder, iterable, body, module_clause),
        ModuleClauseKind::Error => "ERROR".into(),
    };
    documented(&clause.doc, text)
}

fn module_port(p: &ModulePort) -> String {
    format!(
        "(port {}{} {} on:{}{} facing:{}{})",
        p.name.text,
        optional(&p.index, "", expr),
        names(&p.connector),
        p.link.text,
        optional(&p.at, "", placement),
        expr(&p.facing),
        optional(&p.up, "up:", expr)
    )
}

fn placement(p: &Placement) -> String {
    let turned = |args: &Vec<Arg>| format!("(turned{})", each(args, arg));
    format!("at:{}{}", expr(&p.position), each(&p.turned, turned))
}

fn branch<T>(condition: &Expr, then: &[T], otherwise: &[T], show: fn(&T) -> String) -> String {
    let otherwise =
        if otherwise.is_empty() { String::new() } else { format!(" (else{})", each(otherwise, show)) };
    format!("(if {}{}{otherwise})", expr(condition), each(then, show))
}

fn looped<T>(binder: &Name, iterable: &Expr, body: &[T], show: fn(&T) -> String) -> String {
    format!("(for {} {}{})", binder.text, expr(iterable), each(body, show))
}

fn require(r: &Require) -> String {
    format!("(require {}{})", expr(&r.condition), optional(&r.message, "", expr))
}

fn study(s: &Study) -> String {
    let axis = |axis: &StudyAxis| format!(" ({} {})", axis.name.text, expr(&axis.domain));
    let (axes, each): (String, String) =
        (s.axes.iter().map(axis).collect(), s.each.iter().map(axis).collect());
    let settings: String = s.settings.iter().map(|a| format!(" {}", arg(a))).collect();
    format!("(study {}{axes} by {}{settings} each{each} {})", s.name.text, s.sampler.text, expr(&s.body))
}

fn config(c: &Config) -> String {
    let closed = if c.closed.is_some() { " closed" } else { "" };
    let word = if c.scene { "scene" } else { "config" };
    format!("({word} {}{}{closed}{})", c.name.text, params(&c.params), each(&c.clauses, config_clause))
}

fn config_clause(clause: &ConfigClause) -> String {
    let text = match &clause.kind {
        ConfigClauseKind::Part(p) => part(p),
        ConfigClauseKind::Port { name, count, value } => {
            format!("(port {}{} {})", name.text, optional(count, "count:", expr), expr(value))
        }
        ConfigClauseKind::Base(p) => format!("(base {})", path(p)),
        ConfigClauseKind::Behavior(b) => behavior(b),
        ConfigClauseKind::Connect { a, b, turn } => {
            format!("(connect {} {}{})", path(a), path(b), optional(turn, "turn:", expr))
        }
        ConfigClauseKind::Set { joint, value } => format!("(set {} {})", path(joint), expr(value)),
        ConfigClauseKind::Obstacle { name, index, value, at } => format!(
            "(obstacle {}{} {}{})",
            name.text,
            optional(index, "index:", expr),
            expr(value),
            optional(at, "", placement)
        ),
        ConfigClauseKind::World(value) => format!("(world {})", expr(value)),
        ConfigClauseKind::Let(l) => let_item(l),
        ConfigClauseKind::Require(r) => require(r),
        ConfigClauseKind::If { condition, then, otherwise } => {
            branch(condition, then, otherwise, config_clause)
        }
        ConfigClauseKind::For { binder, iterable, body } => looped(binder, iterable, body, config_clause),
        ConfigClauseKind::Error => "ERROR".into(),
    };
    documented(&clause.doc, text)
}

fn part(p: &Part) -> String {
    let count = match &p.count {
        None => String::new(),
        Some(PartCount::Number(n)) => format!(" count:{}", expr(n)),
        Some(PartCount::Each { binder, range }) => format!(" (for {} {})", binder.text, expr(range)),
    };
    let args = p.args.as_ref().map_or(String::new(), |args| format!(" (args{})", each(args, arg)));
    let at = optional(&p.at, "", placement);
    format!("(part {}{count} {}{args}{at})", p.name.text, names(&p.ty))
}

fn behavior(b: &Behavior) -> String {
    let exemption = |e: &Exemption| match e.args.is_empty() {
        true => e.name.text.to_string(),
        false => format!("({}{})", e.name.text, each(&e.args, expr)),
    };
    let allows = each(&b.allows, exemption);
    let allows = if allows.is_empty() { allows } else { format!(" allows:[{}]", allows.trim()) };
    format!("(behavior {}{}{allows} {})", b.name.text, params(&b.params), expr(&b.body))
}

fn path(p: &Path) -> String {
    let step = |step: &PathStep| match step {
        PathStep::Field(name) => format!(".{}", name.text),
        PathStep::Index { index, .. } => format!("[{}]", expr(index)),
    };
    format!("{}{}", p.root.text, p.steps.iter().map(step).collect::<String>())
}

fn truss_clause(clause: &TrussClause) -> String {
    match &clause.kind {
        TrussClauseKind::Node { name, index, value } => {
            format!("(node {}{} {})", name.text, optional(index, "", expr), expr(value))
        }
        TrussClauseKind::Strut { a, b } => format!("(strut {} {})", path(a), path(b)),
        TrussClauseKind::Let(l) => let_item(l),
        TrussClauseKind::Require(r) => require(r),
        TrussClauseKind::If { condition, then, otherwise } => {
            branch(condition, then, otherwise, truss_clause)
        }
        TrussClauseKind::For { binder, iterable, body } => looped(binder, iterable, body, truss_clause),
        TrussClauseKind::Error => "ERROR".into(),
    }
}

fn statement(s: &Stmt) -> String {
    match &s.kind {
        StmtKind::Let(l) => let_item(l),
        StmtKind::Expr(e) => expr(e),
        StmtKind::Expect { condition, message } => {
            format!("(expect {}{})", expr(condition), optional(message, "", expr))
        }
        StmtKind::Require(r) => require(r),
        StmtKind::Ensure(r) => require(r).replacen("require", "ensure", 1),
        StmtKind::If { condition, then, otherwise } => branch(condition, then, otherwise, statement),
        StmtKind::For { binder, iterable, body } => looped(binder, iterable, body, statement),
        StmtKind::Error => "ERROR".into(),
    }
}

fn arg(a: &Arg) -> String {
    format!("{}{}", a.name.map_or(String::new(), |name| format!("{}:", name.text)), expr(&a.value))
}

fn expr(e: &Expr) -> String {
    match &e.kind {
        ExprKind::Number { digits, unit: u } => {
            format!("{digits}{}", u.as_ref().map_or(String::new(), |u| format!("'{}", unit(u))))
        }
        ExprKind::Bool(value) => value.to_string(),
        ExprKind::Text(parts) => text(parts),
        ExprKind::Name(name) => name.to_string(),
        ExprKind::Axis(axis) => format!("{axis:?}"),
        ExprKind::Hole => "_".into(),
        ExprKind::List(values) => format!("[{}]", each(values, expr).trim()),
        ExprKind::Comprehension { body, clauses } => {
            format!("(each {}{})", expr(body), each(clauses, comprehension_clause))
        }
        ExprKind::Unary { op, operand, .. } => {
            let op = match op {
                UnaryOp::Neg => "-",
                UnaryOp::Plus => "+",
                UnaryOp::Not => "not",
            };
            format!("({op} {})", expr(operand))
        }
        ExprKind::Binary { op, left, right, .. } => format!("({op:?} {} {})", expr(left), expr(right)),
        ExprKind::Range { from, to } => format!("(.. {} {})", expr(from), expr(to)),
        ExprKind::Otherwise { value, otherwise } => format!("(else {} {})", expr(value), expr(otherwise)),
        ExprKind::Call { callee, args } => format!("(call {}{})", expr(callee), each(args, arg)),
        ExprKind::Index { object, index } => format!("(at {} {})", expr(object), expr(index)),
        ExprKind::Field { object, field } => format!("{}.{}", expr(object), field.text),
        ExprKind::With { object, fields } => format!("(with {}{})", expr(object), each(fields, arg)),
        ExprKind::If { condition, then, otherwise } => {
            format!("(if {} {}{})", expr(condition), expr(then), optional(otherwise, "", |e| expr(e)))
        }
        ExprKind::Block { statements, value } => {
            let value = optional(value, "", |value| expr(value));
            format!("{{{}{value}}}", each(statements, statement)).replacen("{ ", "{", 1)
        }
        ExprKind::Lambda { params, body } => {
            format!("(=> ({}) {})", each(params, |p| p.text.to_string()).trim(), expr(body))
        }
        ExprKind::Error => "ERROR".into(),
    }
}

fn text(parts: &[TextPart]) -> String {
    let part = |part: &TextPart| match part {
        TextPart::Literal(text) => format!("{text:?}"),
        TextPart::Value(value) => expr(value),
        TextPart::Shown { value, unit, decimals } => {
            let unit = unit.as_ref().map_or(String::new(), |unit| format!(" {:?}", unit.factors));
            let decimals = decimals.map_or(String::new(), |(digits, _)| format!(" .{digits}"));
            format!("(shown {}{unit}{decimals})", expr(value))
        }
    };
    match parts {
        [TextPart::Literal(text)] => format!("{text:?}"),
        parts => format!("(text{})", each(parts, part)),
    }
}

fn comprehension_clause(clause: &ComprehensionClause) -> String {
    match clause {
        ComprehensionClause::For { binder, iterable } => format!("(for {} {})", binder.text, expr(iterable)),
        ComprehensionClause::If(condition) => format!("(if {})", expr(condition)),
    }
}
