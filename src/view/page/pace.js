// Adaptive resolution while things move: where frames come too slowly for the eye, as with a renderer in
// software, the shadows of the sky, highlights and soft edges go first, those of shadows, too, then the shadows of the
// sun, drawn edges, pixels and the cube of sides, then the detail of what is small. What stands still is drawn in full.

/** Slower than this a motion is seen as single pictures, ms. */
const FRAME_MAX = 40;
/** Frames of one kind before it is judged; one that takes several times as long counts as several. */
const FRAMES_JUDGED = 6;
const FRAME_WEIGHT_MAX = 6;
/** As fast as this for so long, ms, and the next finer kind is tried, so many times. */
const FRAME_EASY = 20;
const EASY_FOR = 3000;
const CLIMBS_MAX = 2;
/** A page that has just been opened is slow for other reasons, ms. */
const SETTLED_AFTER = 600;
/** What is left, from the finest on: of the pixels each way; of the size by which bodies get their detail. */
const PIXELS = [1, 1, 0.7, 0.5];
const DETAIL = [1, 0.4, 0.3, 0.1];

/** `slowly`: whether it is drawn in software, as far as is known. */
function paceOf(slowly) {
  let [level, slow, easy, climbs, age] = [slowly ? 1 : 0, 0, 0, 0, 0];
  const to = next => ((level = next), (slow = easy = 0), true);
  return {
    /** A frame took so long, ms; says whether the next are to be drawn otherwise. */
    saw(time) {
      age += time;
      if (age < SETTLED_AFTER) return false;
      slow = time > FRAME_MAX ? slow + Math.min(Math.floor(time / FRAME_MAX), FRAME_WEIGHT_MAX) : Math.max(slow - 2, 0);
      easy = time < FRAME_EASY ? easy + time : 0;
      if (slow >= FRAMES_JUDGED && level + 1 < PIXELS.length) return to(level + 1);
      if (easy >= EASY_FOR && level > 0 && climbs < CLIMBS_MAX) return climbs++, to(level - 1);
      return false;
    },
    level: () => level,
  };
}
