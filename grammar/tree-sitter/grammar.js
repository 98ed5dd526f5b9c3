// The grammar of modl for tree-sitter, rule by rule that of ../modl.pest. `(`, `[`, `+` and `-` go on with an expression on the
// line of its last token alone: the scanner (src/scanner.c) tells them from those that begin something else, and `ensure` before a
// condition from the name.
//
// After a change: `cargo run --manifest-path tool/Cargo.toml -- generate`, and commit what it writes.

const several = rule => optional(seq(rule, repeat(seq(",", rule)), optional(",")));
/** Fields on lines of their own, or between commas. */
const lines = rule => repeat(seq(rule, optional(",")));
const braces = rule => seq("{", repeat(rule), "}");
const unit = /[A-Za-z_][A-Za-z0-9_]*(\^-?[0-9]+)?([*\/][A-Za-z_][A-Za-z0-9_]*(\^-?[0-9]+)?)*/;

module.exports = grammar({
  name: "modl",
  word: $ => $.name,
  extras: $ => [/\s/, $.line_comment, $.block_comment],
  externals: $ => [$.block_comment, $._call, $._index, $._plus, $._minus, $._ensure, $._never],
  supertypes: $ => [$._declaration, $._statement],

  rules: {
    file: $ => repeat(choice($._declaration, $._statement)),

    line_comment: _ => token(seq("//", /[^\n]*/)),
    name: _ => /[A-Za-z_][A-Za-z0-9_]*/,
    number: _ => token(/[0-9][0-9_]*(\.[0-9][0-9_]*)?([eE][+-]?[0-9][0-9_]*)?([A-Za-z_][A-Za-z0-9_]*(\^-?[0-9]+)?([*\/][A-Za-z_][A-Za-z0-9_]*(\^-?[0-9]+)?)*)?/),

    text: $ => seq('"', repeat(choice($.characters, $.escape, $.hole)), token.immediate('"')),
    characters: _ => token.immediate(prec(1, /[^"\\{\n]+/)),
    escape: _ => token.immediate(choice(/\\u\{[0-9A-Fa-f]*\}/, /\\[^\n]/)),
    hole: $ => seq(token.immediate("{"), $._expr, optional(seq("in", $.unit)), optional(seq(":", $.digits)), "}"),
    unit: _ => token(unit),
    digits: _ => /\.[0-9]+/,
    raw_text: _ => token(prec(2, /"""([^"]|"[^"]|""[^"])*"""/)),
    plain_text: _ => token(/"([^"\\\n]|\\[^\n])*"/),

    // Declarations.
    _declaration: $ => choice($.use, $.function, $.record, $.connector, $.module, $.cell, $.strut, $.config, $.scene, $.lattice, $.truss, $.study, $.test, $.extern),
    use: $ => seq("use", choice($.name, $.plain_text), repeat(seq(".", $.name)), optional(seq(".", "{", several($.use_name), "}"))),
    path: $ => prec.right(seq($.name, repeat(seq(".", $.name)))),
    use_name: $ => seq($.name, optional(seq("as", $.name))),
    function: $ => seq("fn", field("name", $.name), optional($.type_parameters), $.parameters, optional(seq("->", $._type)), "=", $._body),
    parameters: $ => seq(choice("(", $._call), several($.parameter), ")"),
    parameter: $ => seq(field("name", $.name), ":", $._type, optional("..."), optional(seq("=", $._expr))),
    type_parameters: $ => seq("<", several(seq($.name, optional(seq(":", $.name)))), ">"),
    record: $ => seq("record", field("name", $.name), "{", lines($.field), "}"),
    field: $ => seq(field("name", $.name), ":", $._type, optional(seq("=", $._expr))),
    study: $ => seq("study", field("name", $.name), choice("(", $._call), several($.axis), ")", "by", $.name, $.arguments, repeat(seq("each", $.axis)), "=", $._body),
    axis: $ => seq($.name, "in", $._expr),
    test: $ => seq("test", $.plain_text, $.block),
    extern: $ => seq("extern", choice($.extern_function, $.extern_type)),
    extern_function: $ => seq("fn", field("name", $.name), optional($.type_parameters), $.parameters, optional(seq("->", $._type))),
    extern_type: $ => prec.right(seq("type", field("name", $.name), optional(seq("is", $.name)), optional(seq("{", repeat(seq(choice($.extern_function, $.field), optional(","))), "}")))),

    // Types.
    _type: $ => prec.right(seq($._type_one, repeat(seq("|", $._type_one)))),
    _type_one: $ => prec.right(seq(choice($.function_type, $.quantity_type, $.type, seq("(", $._type, ")")), repeat("?"))),
    type: $ => prec.right(seq($.path, optional(seq("<", several($._type), ">")))),
    function_type: $ => prec.right(seq("fn", choice("(", $._call), several($._type), ")", "->", $._type)),
    quantity_type: $ => seq("Quantity", "<", choice($.unit, alias($._inverse, $.unit)), ">"),
    _inverse: _ => token(/1\/[A-Za-z_][A-Za-z0-9_]*(\^-?[0-9]+)?([*\/][A-Za-z_][A-Za-z0-9_]*(\^-?[0-9]+)?)*/),

    // Connectors, modules, cells, struts.
    connector: $ => seq("connector", field("name", $.name), braces(choice($.mates, $.turns, $.holds, $.capture, $.snap, $.hinge, ",", $.name))),
    // More names follow behind commas, as clauses may.
    mates: $ => seq("mates", $.name),
    turns: $ => seq("turns", $._expr),
    holds: $ => seq("holds", $._expr),
    capture: $ => prec.right(seq("capture", repeat1($._expr))),
    snap: _ => "snap",
    hinge: $ => seq("hinge", $.arguments),
    module: $ => seq("module", field("name", $.name), optional($.parameters), $.module_body),
    module_body: $ => braces($._module_clause),
    _module_clause: $ => choice($.port, $.joint, $.link, $.mass, $.motor, $.touching, $.touch, $.contact, $.alias, $.let, $.require, $.module_if, $.module_for),
    mass: $ => seq("mass", $._expr),
    touch: $ => seq("touch", $._expr),
    contact: $ => seq("contact", $._expr),
    link: $ => seq("link", field("name", $.name), "=", $._expr, repeat(choice($.collides, $.placement))),
    collides: $ => seq("collides", $._expr),
    joint: $ => seq("joint", field("name", $.name), choice(seq(":", $.name, "->", $.name, "=", $._expr, optional($.placement)), seq("=", $._expr))),
    port: $ => seq("port", field("name", $.name), optional($.index), ":", $.path, "on", $.name, optional($.placement), $.facing, optional($.up)),
    placement: $ => prec.right(seq("at", $._expr, repeat($.turned))),
    turned: $ => seq("turned", $.arguments),
    facing: $ => seq("facing", $._expr),
    up: $ => seq("up", $._expr),
    motor: $ => prec.right(seq("motor", field("name", $.name), "=", $.linear, optional($.arguments))),
    linear: $ => prec.right(seq($._linear_operand, repeat(seq(choice("+", "-", $._plus, $._minus, "*", "/"), $._linear_operand)))),
    _linear_operand: $ => prec.right(seq(repeat(choice("-", "+")), choice($.number, $.name, $.parenthesized), repeat(choice($.index, $.member)))),
    touching: $ => seq("touching", $.name, $.name),
    alias: $ => seq("alias", field("name", $.name), "=", $.name),
    module_if: $ => seq("if", $._expr, $.module_body, repeat(seq("else", "if", $._expr, $.module_body)), optional(seq("else", $.module_body))),
    module_for: $ => seq("for", $.name, "in", $._expr, $.module_body),
    cell: $ => seq("cell", field("name", $.name), optional($.parameters), $._facts),
    strut: $ => seq("strut", field("name", $.name), optional($.parameters), $._facts),
    _facts: $ => seq("{", lines($.fact), "}"),
    fact: $ => seq(field("name", $.name), $._expr),

    // Configurations and scenes.
    config: $ => seq("config", field("name", $.name), optional($.parameters), optional("closed"), $.config_body),
    scene: $ => seq("scene", field("name", $.name), optional($.parameters), optional("closed"), $.config_body),
    config_body: $ => braces($._config_clause),
    _config_clause: $ => choice($.connect, $.behavior, $.part, $.set, $.let, $.config_for, $.config_if, $.config_port, $.base, $.require, $.obstacle, $.world),
    part: $ => prec.right(seq("part", field("name", $.name), optional($.part_count), ":", $.path, optional($.arguments), optional($.placement))),
    part_count: $ => seq(choice("[", $._index), optional(seq($.name, "in")), $._expr, "]"),
    obstacle: $ => seq("obstacle", field("name", $.name), optional($.index), "=", $._expr, optional($.placement)),
    world: $ => seq("world", $.arguments),
    config_port: $ => seq("port", field("name", $.name), optional($.index), "=", $._expr),
    base: $ => seq("base", $.place),
    behavior: $ => seq("behavior", field("name", $.name), optional($.parameters), optional(seq("allows", $.exemption, repeat(seq(",", $.exemption)))), "=", $._body),
    exemption: $ => seq($.name, optional(seq(choice("(", $._call), several($._expr), ")"))),
    connect: $ => seq("connect", $.place, "--", $.place, optional(seq("turn", $._expr))),
    set: $ => seq("set", $.place, "=", $._expr),
    place: $ => prec.right(seq($.name, repeat(choice($.index, $.member)))),
    config_if: $ => seq("if", $._expr, $.config_body, repeat(seq("else", "if", $._expr, $.config_body)), optional(seq("else", $.config_body))),
    config_for: $ => seq("for", $.name, "in", $._expr, $.config_body),

    // Lattices and trusses.
    lattice: $ => seq("lattice", field("name", $.name), optional($.parameters), "of", $.path, "=", $._body),
    truss: $ => seq("truss", field("name", $.name), optional($.parameters), "of", $.path, choice($.truss_body, seq("=", $._body))),
    truss_body: $ => braces(choice($.node, $.truss_strut, $.let, $.require, $.truss_if, $.truss_for)),
    node: $ => seq("node", field("name", $.name), optional($.index), "=", $._expr),
    truss_strut: $ => seq("strut", $.place, "--", $.place),
    truss_if: $ => seq("if", $._expr, $.truss_body, repeat(seq("else", "if", $._expr, $.truss_body)), optional(seq("else", $.truss_body))),
    truss_for: $ => seq("for", $.name, "in", $._expr, $.truss_body),

    // Statements.
    _statement: $ => choice($.let, $.expect, $.require, $.ensure, $.for, $._expr),
    let: $ => seq("let", field("name", $.name), optional(seq(":", $._type)), "=", $._body),
    expect: $ => seq("expect", $._expr, optional(seq(",", $._expr))),
    require: $ => seq("require", $._expr, optional(seq(",", $._expr))),
    ensure: $ => seq(alias($._ensure, "ensure"), $._expr, optional(seq(",", $._expr))),
    for: $ => seq("for", $.name, "in", $._expr, $.block),
    block: $ => seq("{", repeat($._statement), "}"),
    _body: $ => choice($.block, $._expr),

    // Expressions: a flat list, as in modl.pest.
    _expr: $ => $.expression,
    expression: $ => prec.right(seq($._operand, repeat(choice(
      $.arguments, $.index, $.member, $.with,
      seq($.operator, $._operand),
      seq("=>", choice($.block, $._operand)),
    )))),
    operator: $ => choice(
      $._plus, $._minus, "**", "*", "/", "..", "++", "==", "!=", "<->", "<=", "<>", "<", ">=", ">", "%", "^", "&&", "||", "and", "or", prec(-1, "else"),
    ),
    _operand: $ => prec.right(seq(repeat(choice("-", "+", "not", "!", alias($._minus, "-"), alias($._plus, "+"))), $._primary)),
    _primary: $ => choice($.name, $.number, $.list, $.parenthesized, $.raw_text, $.text, $.if_chain),
    list: $ => seq(choice("[", $._index), optional(seq($._expr, choice(seq($.each, repeat(choice($.each, $.filter))), seq(repeat(seq(",", $._expr)), optional(","))))), "]"),
    each: $ => seq("for", $.name, "in", $._expr),
    filter: $ => seq("if", $._expr),
    parenthesized: $ => seq(choice("(", $._call), several($._expr), ")"),
    if_chain: $ => prec.right(seq("if", $._expr, $.block, repeat(seq("else", "if", $._expr, $.block)), optional(seq("else", $.block)))),
    member: $ => seq(".", field("name", $.name)),
    with: $ => seq("with", "{", lines(seq($.label, $._expr)), "}"),
    index: $ => seq($._index, $._expr, "]"),
    arguments: $ => seq($._call, several(seq(optional($.label), $._expr)), ")"),
    label: $ => seq($.name, choice(":", "=")),
  },
});
