// run E0503
fn f(n: Int) -> Int = f(n + 1)
print(f(0))
//    ^^^^ recursion deeper than the limit; the calls that led here
