// check E0104
use "import_cycle_a.mod".{A}
let B = 2
