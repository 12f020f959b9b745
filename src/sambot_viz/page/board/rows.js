// @ts-check
/* The rows of the board: their order, and what is said of a student. */

/**
 * @typedef {{number: number, name: string, shown: boolean, order: number[], stuck: boolean,
 *   step: number, title: string, tries: number, points: number, errors: number,
 *   warnings: number, unmet: number, first: string, pages: number, changed: number,
 *   since: number, trouble: string, server: string}} BoardRow times are seconds since 1970, 0 for never
 */

/** Who is stuck for longest comes first. @param {BoardRow[]} rows */
export function sorted(rows) {
  return [...rows].sort((a, b) => {
    const at = a.order.findIndex((one, place) => one !== b.order[place]);
    return at < 0 ? 0 : Number(a.order[at]) - Number(b.order[at]);
  });
}

/** @param {number} count @param {string} noun */
const counted = (count, noun) => `${count} ${noun}${count === 1 ? "" : "s"}`;

/** Where a student is: the open pages, or why none answers. @param {BoardRow} row */
export const presence = ({ server, pages }) => server || pages || "away";

/** What is wrong with a student's files now. @param {BoardRow} row */
export function problems({ errors, warnings }) {
  const said = [];
  if (errors) said.push(counted(errors, "error"));
  if (warnings) said.push(counted(warnings, "warning"));
  return said.join(", ") || "none";
}

/** How long ago something was. @param {number} at [s] @param {number} now [s] */
export function ago(at, now) {
  if (!at) return "–";
  const minutes = Math.floor(Math.max(0, now - at) / 60);
  if (minutes < 1) return "now";
  if (minutes < 60) return `${minutes} min`;
  return minutes < 1440 ? `${Math.floor(minutes / 60)} h` : `${Math.floor(minutes / 1440)} d`;
}

/** The whole class in a line. @param {BoardRow[]} rows @param {number} steps */
export function summary(rows, steps) {
  const stuck = rows.filter((row) => row.stuck && row.step <= steps).length;
  const here = rows.filter(({ pages, server }) => pages && !server).length;
  const done = rows.filter(({ step }) => step > steps).length;
  return `${counted(rows.length, "student")}, ${here} here, ${stuck} stuck, ${done} done`;
}
