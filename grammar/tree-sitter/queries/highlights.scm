; Colours of modl programs.

(line_comment) @comment
(block_comment) @comment
[(text) (plain_text) (raw_text)] @string
(escape) @string.escape
(hole ["{" "}"] @punctuation.special)
(number) @number
(unit) @number
(digits) @number

((name) @type (#match? @type "^[A-Z].+"))
((name) @constant.builtin (#match? @constant.builtin "^(true|false|X|Y|Z)$"))
(parameter name: (name) @variable.parameter)
(label (name) @variable.parameter)
(member name: (name) @property)
(function name: (name) @function)
(extern_function name: (name) @function)
(behavior name: (name) @function)
"Quantity" @type

[
  "use" "as" "fn" "record" "study" "by" "each" "test" "extern" "type" "is"
  "connector" "mates" "turns" "holds" "capture" "hinge"
  "module" "mass" "touch" "contact" "link" "collides" "joint" "port" "on" "at" "turned" "facing" "up" "motor" "touching" "alias"
  "cell" "strut" "config" "scene" "closed" "part" "obstacle" "world" "base" "behavior" "allows" "connect" "turn" "set"
  "lattice" "of" "truss" "node"
  "let" "expect" "require" "ensure" "for" "in" "if" "else" "and" "or" "not" "with"
] @keyword
(snap) @keyword

[":" "," "."] @punctuation.delimiter
["(" ")" "[" "]" "{" "}"] @punctuation.bracket
["=" "->" "--" "=>" ".." "++" "==" "!=" "<=" "<" ">=" ">" "%" "^" "*" "/"] @operator
