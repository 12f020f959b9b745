// @ts-check
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  clock,
  clocks,
  keyGoes,
  liveTime,
  sizeText,
  timeNow,
  times,
  typedTime,
} from "../../src/sambot_viz/page/window/player_bar.js";

test("times are minutes and seconds", () => {
  assert.equal(clock(0), "0:00.0");
  assert.equal(clock(9.96), "0:10.0");
  assert.equal(clock(59.97), "1:00.0");
  assert.equal(clock(3723.4), "62:03.4");
  assert.equal(clock(9.9996, 3), "0:10.000");
  assert.equal(clock(7.1234, 3), "0:07.123");
});

test("a time has the same digits as the length: thousandths at rest", () => {
  assert.equal(clocks(7.1234, 20.0004, true), "0:07.1 / 0:20.0");
  assert.equal(clocks(7.1234, 20.0004, false), "0:07.123 / 0:20.000");
});

test("the time goes on from what was told, and not past the end", () => {
  const told = { value: 2, at: 1000 };
  assert.equal(timeNow(told, 1, 20, 1500), 2.5);
  assert.equal(timeNow(told, 2, 20, 1500), 3);
  assert.equal(timeNow(told, 1, 20, 60000), 20);
  // Clocks may be a little apart.
  assert.equal(timeNow(told, 1, 20, 900), 2);
});

test("a time can be typed as people write it, and as messages are stamped", () => {
  const begin = 1_700_000_000;
  for (const [text, seconds] of /** @type {[string, number][]} */ ([
    ["7", 7],
    [" 7.25 s ", 7.25],
    ["7,25", 7.25],
    ["1:02.5", 62.5],
    ["1:00:00", 3600],
    ["1700000003.5", 3.5],
    [".5", 0.5],
  ]))
    assert.equal(typedTime(text, begin), seconds, text);
  for (const text of ["", "abc", "-1", "1:", "1:2:3:4", "1e3", "0x10"])
    assert.equal(typedTime(text, begin), null, text);
});

test("what is shown at rest can be typed again", () => {
  for (const seconds of [0, 0.001, 9.999, 59.5, 61.25, 3723.4])
    assert.ok(Math.abs((typedTime(clock(seconds, 3), 0) ?? -1) - seconds) < 1e-9);
});

test("keys go a second, a tenth, or to an end", () => {
  assert.equal(keyGoes("ArrowLeft", 20), -1);
  assert.equal(keyGoes("PageUp", 20), 2);
  assert.equal(keyGoes("Home", 20), -20);
  assert.equal(keyGoes("a", 20), undefined);
});

test("the times are those of RViz's panel, with two decimals", () => {
  assert.deepEqual(times(105.5, 1000.126, 100, 900), [
    ["ROS Time", "105.50"],
    ["ROS Elapsed", "5.50"],
    ["Wall Time", "1000.13"],
    ["Wall Elapsed", "100.13"],
  ]);
});

test("sizes of recordings have a unit that fits", () => {
  assert.equal(sizeText(0), "0 kB");
  assert.equal(sizeText(81_234), "81 kB");
  assert.equal(sizeText(1_250_000), "1.3 MB");
  assert.equal(sizeText(2_400_000_000), "2.4 GB");
});

test("the time of a live robot goes on by itself, and that of a simulation at its rate", () => {
  const own = { simulated: false, time: 60, rate: 1 };
  assert.equal(liveTime(own, 0, 5000, 1000), 1060);
  const simulated = { simulated: true, time: 12, rate: 0.5 };
  assert.equal(liveTime(simulated, 1000, 3000, 1000), 13);
  assert.equal(liveTime({ ...simulated, rate: 0 }, 1000, 3000, 1000), 12);
});
