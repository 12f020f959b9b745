// What people type as a number, and how a number is written and stepped.

import assert from "node:assert/strict";
import { test } from "node:test";

import {
  clamped,
  fittingNumber,
  formatNumber,
  parseNumber,
  snapped,
  stepped,
  writtenNumber,
} from "../../src/sambot_viz/page/cells/numbers.js";

/** @param {string} typed @param {number} value @param {string} [unit] */
function reads(typed, value, unit = "rad") {
  const read = parseNumber(typed, unit);
  assert.ok("value" in read, `${typed}: ${JSON.stringify(read)}`);
  assert.ok(Math.abs(read.value - value) < 1e-12, `${typed}: ${read.value}`);
}

/** @param {string} typed @param {RegExp} why @param {string} [unit] */
function refuses(typed, why, unit = "rad") {
  const read = parseNumber(typed, unit);
  assert.ok("error" in read, `${typed}: ${JSON.stringify(read)}`);
  assert.match(read.error, why);
}

test("plain numbers are read in every common form", () => {
  reads("1.5", 1.5);
  reads(" -0.25 ", -0.25);
  reads("−2", -2);
  reads("+3", 3);
  reads(".5", 0.5);
  reads("5.", 5);
  reads("1e-3", 0.001);
  reads("1E3", 1000);
});

test("a comma is a decimal point", () => {
  reads("1,5", 1.5);
  reads(",5", 0.5);
  refuses("1,234.5", /not a number/);
});

test("sums, products, brackets and pi are worked out", () => {
  reads("pi/2", Math.PI / 2);
  reads("-π", -Math.PI);
  reads("2pi", 2 * Math.PI);
  reads("2*pi/3", (2 * Math.PI) / 3);
  reads("tau/4", Math.PI / 2);
  reads("(1+2)/4", 0.75);
  reads("1-2-3", -4);
});

test("a unit may be typed, and a plain number has the unit that is shown", () => {
  reads("90deg", Math.PI / 2);
  reads("90 °", Math.PI / 2);
  reads("90", Math.PI / 2, "°");
  reads("1.5 rad", 1.5, "°");
  reads("15 mm", 0.015, "m");
  reads("2 cm", 0.02, "m");
  reads("3", 3, "Hz");
});

test("an angle with pi is in radians, whatever unit is shown", () => {
  reads("pi", Math.PI, "°");
  reads("-pi/2", -Math.PI / 2, "°");
  reads("tau", 2 * Math.PI, "°/s");
  reads("pi deg", (Math.PI * Math.PI) / 180, "rad");
  reads("2pi", 2 * Math.PI, "m");
});

test("a sentence has one sign for what is below zero", () => {
  assert.equal(writtenNumber(-1.25, 2), "−1.25");
  assert.equal(writtenNumber(-1e-9, 4), "−1e−9");
});

test("a rate is read like an angle or a length per second", () => {
  reads("90", Math.PI / 2, "°/s");
  reads("90 deg/s", Math.PI / 2, "rad/s");
  reads("1.5rad", 1.5, "°/s");
  reads("20 cm/s", 0.2, "m/s");
  refuses("1 rad/s", /does not fit/, "rad");
});

test("what is no number is refused with a reason", () => {
  for (const typed of [
    "abc",
    "1 2",
    "1..2",
    "1.5x",
    "(1",
    "1)",
    "e",
    "--",
    "2 +",
    "1..2",
    "1/0",
    "1e999",
    "pi pi (",
  ]) {
    refuses(typed, /is not a number/);
  }
  refuses("", /Enter a number/);
  refuses("   ", /Enter a number/);
  refuses("3 m", /'m' does not fit: the unit is rad/);
  refuses("90deg", /'deg' does not fit: the unit is m/, "m");
  refuses("5 mm", /the unit is none/, "");
});

test("a number is written with no more digits than it needs", () => {
  assert.equal(formatNumber(1.5), "1.5");
  assert.equal(formatNumber(0.1 + 0.2), "0.3");
  assert.equal(formatNumber(Math.PI), "3.141593");
  assert.equal(formatNumber(-0), "0");
  assert.equal(formatNumber(1e-9), "1e-9");
  assert.equal(formatNumber(2e9), "2000000000");
  assert.equal(formatNumber(NaN), "");
});

test("steps end on round numbers", () => {
  assert.equal(stepped(0, 0.01, 1), 0.01);
  assert.equal(stepped(0.3, 0.01, -1), 0.29);
  assert.equal(stepped(0.29, 0.01, 10), 0.39);
  assert.equal(stepped(0.123456, 0.01, 1), 0.13);
  assert.equal(stepped(0.123456, 0.01, -1), 0.12);
  assert.equal(stepped(45.5, 1, 1), 46);
  assert.equal(stepped(-1, 1, 10), 9);
});

test("a slider stops at round numbers, and a value stays inside its limits", () => {
  assert.equal(snapped(0.12345, 0.01), 0.12);
  assert.equal(snapped(-44.6, 1), -45);
  assert.equal(clamped(4, { min: -1, max: 1 }), 1);
  assert.equal(clamped(-4, { min: -1 }), -1);
  assert.equal(clamped(4, {}), 4);
});

test("a number in a narrow field has the digits that fit", () => {
  /** @param {number} value @param {string} text @param {number} [digits] @param {number} [room] */
  const shows = (value, text, digits = 4, room = 7) => {
    assert.equal(fittingNumber(value, digits, room), text);
    assert.ok(text.length <= room, text);
  };
  shows(0.5, "0.5");
  shows(0, "0");
  shows(0.1 + 0.2, "0.3");
  shows(-Math.PI, "-3.1416");
  shows(-12.345678, "-12.346");
  shows(123456.789, "123457");
  shows(12345678.9, "1.23e7");
  shows(-180.123456, "-180.12", 2);
  shows(-1.23456, "-1.235", 4, 6);
  shows(1e-5, "1e-5");
  shows(-1.234e-5, "-1.2e-5");
  shows(1e-13, "0");
});

test("a number that runs keeps its count of digits", () => {
  const texts = [1.2, 1.20004, 1.29996, 1.3].map((value) => fittingNumber(value + 1e-7, 4, 7));
  assert.deepEqual(texts, ["1.2000", "1.2000", "1.3000", "1.3000"]);
});
