--- `ensure` begins a statement before a word, a number or a text of its line
config C {
  behavior a = {
    require start.a > 1, "low"
    ensure end.a > 1, "high"
    ensure not b
    go()
  }
}
f(ensure, ensure (1))
let a = ensure + 1
ensure(3)
ensure
g(1)
//> (config C (behavior a {(require (Gt start.a 1) "low") (ensure (Gt end.a 1) "high") (ensure (not b)) (call go)}))
//> (call f ensure (call ensure 1))
//> (let a (Add ensure 1))
//> (call ensure 3)
//> ensure
//> (call g 1)

--- mistakes after `ensure` cost no more than their line
config C {
  behavior a = {
    ensure end.a >
//                ^ E0001 an expression is missing
    ensure b c
//           ^ E0001
    go()
  }
  behavior b = go()
}
//> (config C (behavior a ERROR) (behavior b (call go)))
