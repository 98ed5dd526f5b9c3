//! A chair becomes a spider and crawls away: two ways through the snake and a behaviour, one plan.
use std.rofi.{Chair, Spider}

let change = reconfigure(Chair(), Spider(), seed: 1)
print(change.docks, change.undocks, change.joint_travel)
// `reconfigure` plans at rest, and so the whole is judged.
let crawl = plan(Spider().crawl(steps: 2), world: world(dynamics: statics))
let whole = change ++ crawl
let report = verify(whole)
print(report.ok, report.duration, report.travel)
emit(whole, "chair_to_spider.plan.json")
show(whole, "chair_to_spider.html")
