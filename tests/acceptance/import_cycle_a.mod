// check E0104
use "import_cycle_b.mod".{B}
//  ^^^^^^^^^^^^^^^^^^^^ import cycle: import_cycle_a.mod, import_cycle_b.mod, import_cycle_a.mod
let A = 1
