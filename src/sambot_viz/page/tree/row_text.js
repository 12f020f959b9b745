// @ts-check
/* A row as text, and copying it. */

import { formatNumber } from "../cells/numbers.js";
import { formula, shownNumber, shownUnit, unitBeside } from "../cells/units.js";
import { copy } from "../window/clipboard.js";
import { rows } from "../wire/channel.js";

/** @typedef {import("../wire/rows.js").Row} Row */

/** Kinds of rows whose value is not a text. */
const NO_TEXT = new Set(["display", "group"]);
/** Kinds whose value is shown with its unit. */
const NUMBERS = new Set(["int", "float", "slider", "vector"]);

/** The value of a row as it is shown; "" where there is none. @param {Row} row @returns {string} */
export function valueText(row) {
  const { kind, value } = row;
  if (value === undefined || value === null || NO_TEXT.has(kind)) return "";
  if (kind === "color") return value.join("; ");
  if (kind === "vector")
    return value.map((/** @type {number} */ part) => formatNumber(part, 6)).join("; ");
  if (kind === "lines" && Array.isArray(value)) return value.map(([, line]) => line).join("\n");
  if (typeof value === "number") return formatNumber(value, 6);
  return String(value);
}

/** The name of a row, with its value where it is said in one. @param {Row} row */
export const nameText = (row) => `${row.name}${row.whole ? `: ${row.value}` : ""}`;

/** Between a name and a value in one line: an em space, which a reader does not say. */
const GAP = "\u2003";

/** A row in one line: its name, and its value as its cell shows it. @param {Row} row */
export function lineText(row) {
  const value = row.whole ? "" : cellText(row);
  const text = value ? row.name + GAP + value : nameText(row);
  return text.replace(/\s*\n\s*/g, " ");
}

/** @param {Row} row @returns {string} */
function cellText(row) {
  if (!NUMBERS.has(row.kind))
    return row.kind === "bool"
      ? ""
      : valueText({ ...row, value: rows.data("displays/paths")?.[row.id] ?? row.value });
  const { unit, factor } = shownUnit(row);
  const number =
    row.kind === "vector"
      ? row.value.map((/** @type {number} */ part) => formatNumber(part * factor, 5)).join("; ")
      : shownNumber(row, row.value);
  return [row.follows && formula(row), number, unitBeside(row, unit)].filter(Boolean).join(" ");
}

/**
 * What Ctrl+C on a row copies: a value alone, a status with all that is below it.
 * @param {Row} row @param {Row[]} below
 */
function copyText(row, below) {
  if (row.kind === "note" || row.kind === "lines") return [row, ...below].map(valueText).join("\n");
  if (row.kind === "status")
    return [row, ...below].map((one) => `${one.name}: ${valueText(one)}`).join("\n");
  return valueText(row) || row.name || "";
}

/** All rows below one. @param {string} id @returns {Row[]} */
function allBelow(id) {
  return rows
    .children(id)
    .flatMap((child) => [/** @type {Row} */ (rows.get(child)), ...allBelow(child)]);
}

/** @param {Row} row */
export function copyRow(row) {
  const one = row.kind === "status" ? "the status" : valueText(row) ? "the value" : "the name";
  copy(copyText(row, allBelow(row.id)), `Copied: ${one}`);
}
