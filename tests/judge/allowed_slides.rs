//! Robots at rest at every instant that slide down a slope where a behaviour `allows traction`.

use crate::support::desk::run_clean;

#[test]
fn a_slide_at_rest_that_is_allowed_fails_at_the_end_alone_and_its_way_is_not_followed() {
    let printed = run_clean(
        "module Block { link body = box(200mm, 200mm, 40mm, mass: 1kg, friction: 0.5) }
config One {
  part b: Block
  behavior go allows traction = wait(500ms)
}
let r = verify(One().go(), world: world(terrain: slope(10deg), friction: 0.2, dynamics: statics))
print(join([\"{f}\" for f in r.failures], with: \"; \"))
print(join(r.notes, with: \"; \"))
",
    )
    .printed;
    // No exemption excuses where a plan ends.
    assert!(printed[0].starts_with("at 500ms: the robot slides down the slope"), "{printed:?}");
    assert!(!printed[0].contains("at 0ms"), "{printed:?}");
    assert!(printed[1].contains("the way down the slope is not followed"), "{printed:?}");
}
