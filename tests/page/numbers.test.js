import assert from "node:assert/strict";
import { test } from "node:test";
import { clamped, formatNumber, parseNumber, snapped, stepped } from "../../src/sambot_viz/page/numbers.js";

/** @param {string} typed @param {string} [unit] */
function read(typed, unit) {
  const found = parseNumber(typed, unit);
  assert.ok("value" in found, `${typed}: ${JSON.stringify(found)}`);
  return found.value;
}

/** @param {string} typed @param {string} [unit] */
function refused(typed, unit) {
  const found = parseNumber(typed, unit);
  assert.ok("error" in found, `${typed} was read as ${JSON.stringify(found)}`);
  return found.error;
}

test("numbers are read as people type them", () => {
  assert.equal(read("1.5"), 1.5);
  assert.equal(read(" 1,5 "), 1.5);
  assert.equal(read("1e-3"), 0.001);
  assert.equal(read(".5"), 0.5);
  assert.equal(read("-2"), -2);
  assert.equal(read("−2"), -2);
  assert.equal(read("+2"), 2);
});

test("sums and products are worked out", () => {
  assert.equal(read("pi/2"), Math.PI / 2);
  assert.equal(read("-π/2"), -Math.PI / 2);
  assert.equal(read("2pi"), 2 * Math.PI);
  assert.equal(read("(1+2)/4"), 0.75);
  assert.equal(read("1 - 2 - 3"), -4);
  assert.equal(read("2*(3-1)"), 4);
});

test("a unit that is typed counts more than that of the row", () => {
  assert.equal(read("90deg", "rad"), Math.PI / 2);
  assert.equal(read("90 °", "rad"), Math.PI / 2);
  assert.equal(read("90", "°"), Math.PI / 2);
  assert.equal(read("1 rad", "°"), 1);
  assert.equal(read("15 mm", "m"), 0.015);
});

test("what is no value is refused with what was typed", () => {
  for (const typed of ["abc", "1..2", "1/0", "2 +", "(1", "1)", "1 2"]) {
    assert.ok(refused(typed).includes(typed), typed);
  }
  assert.equal(refused(""), "type a number");
  assert.ok(refused("3 m", "rad").includes("does not fit an angle"));
  assert.ok(refused("3 deg", "m").includes("does not fit a length"));
  assert.ok(refused("3 m", "").includes("no unit 'm'"));
});

test("a number is shown with few digits, and never as another number", () => {
  assert.equal(formatNumber(1.5), "1.5");
  assert.equal(formatNumber(0.1 + 0.2), "0.3");
  assert.equal(formatNumber(1e-9), "1e-9");
  assert.equal(formatNumber(-0), "0");
});

test("steps end on round numbers", () => {
  assert.equal(stepped(0, 0.01, 1), 0.01);
  assert.equal(stepped(0.29, 0.01, 1), 0.3);
  assert.equal(stepped(0.305, 0.01, 1), 0.31);
  assert.equal(stepped(0.305, 0.01, -1), 0.3);
  assert.equal(stepped(-0.305, 0.01, 1), -0.3);
  assert.equal(stepped(0, 0.01, 10), 0.1);
  assert.equal(snapped(0.123456, 0.01), 0.12);
});

test("a value stays within the limits of its row", () => {
  assert.equal(clamped(5, { min: -1, max: 1 }), 1);
  assert.equal(clamped(-5, { min: -1, max: 1 }), -1);
  assert.equal(clamped(5, {}), 5);
});
