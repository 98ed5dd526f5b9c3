//! A chair becomes a spider and crawls away: two ways through the snake and a behaviour, one plan.
use std.rofi.{Chair, Spider}

let change = reconfigure(Chair(), Spider(), seed: 1)
print(change.docks, change.undocks, change.joint_travel)
let whole = change ++ Spider().crawl(steps: 2)
let report = verify(whole)
print(report.ok, report.duration, report.travel)
emit(whole, "chair_to_spider.plan.json")
show(whole, "chair_to_spider.html")
