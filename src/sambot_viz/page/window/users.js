// @ts-check
/* Who is there, and what this user is to the others. */

import { useLayoutEffect, useReducer } from "../vendor/preact.js";
import { Cell, useData, useRow } from "../state.js";
import { act, FOLLOWS, rows } from "../wire/channel.js";

/**
 * @typedef {{presented: boolean, copy: boolean, copies: number, slot?: number, left?: number | null}} State
 *   copies: how many have one; slot: how long a turn is [s]; left: of the one that runs
 * @typedef {{client: number, name: string, presenter: boolean, control: boolean,
 *   requests: boolean, key: string}} Me key: who comes again with it is the same user
 * @typedef {{id: string, name: string, client: number, presenter?: boolean, control?: boolean,
 *   requests?: boolean, place?: number, wait?: number}} Person
 *   place: in the queue, from 1; wait: for how long at most [s]
 * @typedef {{state: State, me: Me, people: Person[], viewers: number, requests: Person[]}} Now
 *   viewers: how many are not in control
 */

const ORDINALS = ["", "first", "second", "third", "fourth", "fifth"];

/** A time in words. @param {number} seconds */
export const timeInWords = (seconds) =>
  seconds < 60 ? `${seconds} s` : `${Math.ceil(seconds / 60)} min`;

/** Where someone is in the queue: "third, 4 min". @param {Person} person */
export const turnInWords = ({ place = 0, wait = 0 }) =>
  `${ORDINALS[place] ?? `number ${place}`}, ${timeInWords(wait)}`;

/** The name of this user, for the next time. @type {Cell<string>} */
export const ownName = new Cell("", "name");
/** Whether the dialog of the status bar is open. @type {Cell<boolean>} */
export const peopleOpen = new Cell(/** @type {boolean} */ (false));

/** What the tab keeps of its user, also while it shows a private copy. */
const KEY = "sambot-viz/user";

function takeKey() {
  try {
    return sessionStorage.getItem(KEY) || "";
  } catch {
    return "";
  }
}

/** @param {string} key */
function keepKey(key) {
  try {
    sessionStorage.setItem(KEY, key);
  } catch {
    // Without storage, a page that comes again is another user.
  }
}

/** Rows that this user may not set look and act like those that cannot be set. */
export function followRole() {
  let client = -1;
  const look = () => {
    const me = /** @type {Me | undefined} */ (rows.data("role/me"));
    if (!me) return;
    rows.watch(!me.control, Boolean(rows.data(FOLLOWS)));
    document.body.classList.toggle("view-only", !me.control);
    // Each connection is a new client, with a name like "Viewer 4". A private copy has other users.
    if (!location.pathname.endsWith("/copy/")) {
      if (client !== me.client) act("role/greet", [ownName.value, takeKey()]);
      keepKey(me.key);
    }
    client = me.client;
  };
  rows.listen("role/me", look);
  look();
}

/** Who is there now. @returns {Now | null} */
export function usePeople() {
  const state = useData("people/state"),
    me = useData("role/me");
  useRow("panel:people");
  const ids = rows.panels.get("people") || [];
  const [, again] = useReducer((/** @type {number} */ n) => n + 1, 0);
  useLayoutEffect(() => {
    const stops = ids.map((id) => rows.listen(id, () => again(0)));
    return () => stops.forEach((stop) => stop());
  }, [ids.join()]);
  if (!state || !me) return null;
  /** @type {Person[]} */
  const people = /** @type {any[]} */ (ids.map((id) => rows.get(id)));
  return {
    state,
    me,
    people,
    viewers: people.filter((person) => !person.control).length,
    requests: people
      .filter((person) => person.requests)
      .sort((one, other) => (one.place ?? 0) - (other.place ?? 0)),
  };
}
