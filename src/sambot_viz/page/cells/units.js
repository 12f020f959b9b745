// @ts-check
/* Numbers with their units and limits as they are shown: angles in radians or degrees. */

import { rows } from "../wire/channel.js";
import { fittingNumber, formatNumber, writtenNumber } from "./numbers.js";
import { degrees } from "../state.js";

/** @typedef {import("../wire/rows.js").Row} Row */

const DEGREE = Math.PI / 180;
/** How many characters fit into the field beside a slider. */
export const NARROW = 7;

/** How a row's number is shown: its unit, how much of it is one of the row's, and its step.
 * @param {Row} row @returns {{unit: string, factor: number, step: number}} */
export function shownUnit(row, inDegrees = degrees.value) {
  const step = row.step || 0.01;
  const turn = inDegrees && (row.unit === "rad" || row.unit === "rad/s");
  if (!turn) return { unit: row.unit || "", factor: 1, step };
  // 0.01 rad is about half a degree; people think in whole ones.
  return { unit: row.unit === "rad" ? "°" : "°/s", factor: 1 / DEGREE, step: step * 100 };
}

/**
 * The number of a row as it is shown; beside a slider there is room for few digits.
 * @param {Row} row @param {number} value in the row's unit
 * @param {number} [room] how many characters fit
 */
export function shownNumber(row, value, room = row.kind === "slider" ? NARROW : undefined) {
  const { factor } = shownUnit(row);
  const few = (row.kind === "slider" ? 4 : 6) - (factor === 1 ? 0 : 2);
  return room ? fittingNumber(value * factor, few, room) : formatNumber(value * factor, few);
}

/** The unit to write beside a number: none where the row's name ends with it, as in "Size (m)".
 * @param {Row} row @param {string} unit as it is shown */
export const unitBeside = (row, unit) => (row.name?.endsWith(`(${unit})`) ? "" : unit);

/** A typed number as its row takes it: whole where only those are, and of a joint that turns without
 * limits the same angle from −π to π. Where that is another one, `said` is what to tell.
 * @param {Row} row @param {number} typed @returns {{value: number, said: string}} */
export function taken(row, typed) {
  const turns = row.wheel && Math.abs(typed) > Math.PI ? Math.round(typed / (2 * Math.PI)) : 0;
  const value = row.kind === "int" ? Math.round(typed) : typed - turns * 2 * Math.PI;
  if (value === typed) return { value, said: "" };
  const { unit, factor } = shownUnit(row);
  const [from, to] = [typed, value].map((one) =>
    `${writtenNumber(one * factor, limitDigits(unit))} ${unit}`.trim(),
  );
  const why = turns ? "a continuous joint turns within ±180°" : "whole numbers only";
  return { value, said: `${from} was taken as ${to}: ${why}` };
}

/** Why a number is outside the limits of its row. @param {Row} row @param {number} value */
export function outside(row, value) {
  const { unit, factor } = shownUnit(row);
  const low = row.min ?? -Infinity;
  const high = row.max ?? Infinity;
  // A limit typed as it is shown, without all its digits, means the limit.
  const near = (0.6 * 10 ** -limitDigits(unit)) / factor;
  if (value >= low - near && value <= high + near) return "";
  const written = (/** @type {number} */ end) => writtenNumber(end * factor, limitDigits(unit));
  if (!Number.isFinite(high)) return `Must be at least ${written(low)} ${unit}`.trim();
  if (!Number.isFinite(low)) return `Must be at most ${written(high)} ${unit}`.trim();
  return `${written(value)} ${unit} is outside ${limits(row)}`;
}

/** @param {string} unit */
const limitDigits = (unit) => (unit.startsWith("°") ? 2 : 4);
/** The limits of a row as they are shown. @param {Row} row */
export function limits(row) {
  const { unit, factor } = shownUnit(row);
  const ends = [row.min ?? -Infinity, row.max ?? Infinity].map((end) =>
    Number.isFinite(end) ? writtenNumber(end * factor, limitDigits(unit)) : end < 0 ? "−∞" : "∞",
  );
  return `${ends[0]} … ${ends[1]} ${unit}`.trim();
}

/**
 * How a joint follows another one, in the units that are shown.
 * @param {Row} row
 * @returns {string}
 */
export function formula(row) {
  const leader = rows.get(row.follows);
  const { factor, unit } = shownUnit(row);
  const times = writtenNumber((row.times * factor) / (leader ? shownUnit(leader).factor : 1), 4);
  const plus = row.plus
    ? ` ${row.plus < 0 ? "−" : "+"} ${writtenNumber(Math.abs(row.plus) * factor, 4)} ${unit}`
    : "";
  return `= ${times === "1" ? "" : `${times} × `}${leader?.name || ""}${plus}`;
}
