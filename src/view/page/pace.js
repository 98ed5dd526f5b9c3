// How finely to draw while things move: where frames come too slowly for the eye, as with a renderer in
// software, shadows go first, then edges and pixels, then the detail of what is small. What stands still
// is drawn in full.

/** Slower than this a motion is seen as single pictures, ms. */
const FRAME_MAX = 45;
/** Frames of one kind before it is judged. */
const FRAMES_JUDGED = 6;
/** What is left, from the finest on: of the pixels each way; of the size by which bodies get their detail. */
const PIXELS = [1, 0.8, 0.5, 0.5];
const DETAIL = [1, 0.4, 0.4, 0.2];

function paceOf() {
  let level = 0;
  let slow = 0;
  return {
    /** A frame took so long, ms; says whether the next are to be drawn more coarsely. */
    saw(time) {
      slow = time > FRAME_MAX ? slow + 1 : Math.max(slow - 2, 0);
      if (slow < FRAMES_JUDGED || level + 1 === PIXELS.length) return false;
      slow = 0;
      level++;
      return true;
    },
    level: () => level,
  };
}
