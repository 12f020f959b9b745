// Numbers with their units and limits.

import assert from "node:assert/strict";
import { test } from "node:test";

import { outside, taken, unitBeside } from "../../src/sambot_viz/page/cells/units.js";

const LIMITED = { id: "a", in: "", kind: "slider", unit: "rad", min: -1, max: 1 };
const WHEEL = { ...LIMITED, min: -Math.PI, max: Math.PI, wheel: true };

test("a joint without limits takes the same angle within a turn", () => {
  for (const [typed, shown] of [
    [9, 9 - 2 * Math.PI],
    [-9, 2 * Math.PI - 9],
    [100, 100 - 32 * Math.PI],
    [Math.PI, Math.PI],
    [-2, -2],
  ]) {
    const { value, said } = taken(WHEEL, typed);
    assert.ok(Math.abs(value - shown) < 1e-12, `${typed}: ${value}`);
    assert.equal(outside(WHEEL, value), "");
    assert.equal(said !== "", value !== typed);
  }
});

test("a typed number that is taken as another one is said", () => {
  assert.equal(
    taken(WHEEL, 10).said,
    "10 rad was taken as −2.5664 rad: a continuous joint turns within ±180°",
  );
  const count = { id: "a", in: "", kind: "int" };
  assert.deepEqual(taken(count, 2.5), { value: 3, said: "2.5 was taken as 3: whole numbers only" });
  assert.deepEqual(taken(count, 3), { value: 3, said: "" });
});

test("a joint with limits does not turn round, and says which they are", () => {
  assert.equal(taken(LIMITED, 9).value, 9);
  assert.equal(outside(LIMITED, 9), "9 rad is outside −1 … 1 rad");
  assert.equal(outside(LIMITED, 1.00001), "");
});

test("a unit that the name of a row says is not written again", () => {
  const row = { ...LIMITED, unit: "m", name: "Size (m)" };
  assert.equal(unitBeside(row, "m"), "");
  assert.equal(unitBeside({ ...row, name: "Length" }, "m"), "m");
  assert.equal(unitBeside({ ...row, name: "Turn (m)" }, "°"), "°");
});
