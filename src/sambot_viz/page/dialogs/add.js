// @ts-check
/* Add: the types of displays with a sentence each, and a name. */

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { rows } from "../wire/channel.js";
import { Icon } from "../window/icons.js";
import { makeDisplay } from "../panels/selected_display.js";
import { Dialog } from "./dialog.js";

/** @typedef {{kind: string, help: string, why?: string}} Type */

/** "rviz_default_plugins/Axes" is "Axes". @param {string} kind */
const nameOf = (kind) => kind.slice(kind.lastIndexOf("/") + 1);

/** @param {Type} a @param {Type} b */
const byName = (a, b) => nameOf(a.kind).localeCompare(nameOf(b.kind));

/** @param {{close: () => void}} props */
export function AddDisplay({ close }) {
  /** @type {Type[]} */
  const types = [...(rows.data("displays/types") || [])].sort(byName);
  const shown = types.filter((type) => !type.why),
    others = types.filter((type) => type.why);
  const [at, setAt] = useState(0);
  const list = useRef(/** @type {any} */ (null)),
    name = useRef(/** @type {any} */ (null));
  const typed = useRef({ text: "", when: 0 });
  useLayoutEffect(() => {
    list.current.querySelector("[aria-selected=true]")?.scrollIntoView({ block: "nearest" });
  }, [at]);
  const chosen = shown[at];
  const add = () => {
    if (!chosen) return;
    const { value } = name.current;
    close();
    makeDisplay("add", [chosen.kind, value], true);
  };
  /** @param {KeyboardEvent} event */
  const key = (event) => {
    const last = shown.length - 1;
    if (event.key === "ArrowDown") setAt(Math.min(last, at + 1));
    else if (event.key === "ArrowUp") setAt(Math.max(0, at - 1));
    else if (event.key === "Home") setAt(0);
    else if (event.key === "End") setAt(last);
    else if (event.key === "Enter") add();
    else if (/^\w$/.test(event.key) && !event.ctrlKey && !event.metaKey) find(event.key);
    else return;
    event.preventDefault();
  };
  /** Letters in quick succession find a name. @param {string} letter */
  const find = (letter) => {
    const now = Date.now();
    typed.current = {
      text: (now - typed.current.when < 1000 ? typed.current.text : "") + letter.toLowerCase(),
      when: now,
    };
    const found = shown.findIndex((type) =>
      nameOf(type.kind).toLowerCase().startsWith(typed.current.text),
    );
    if (found >= 0) setAt(found);
  };
  /** @param {Type} type @param {number} i */
  const option = (
    type,
    i,
  ) => html`<div role="option" id=${`add-${nameOf(type.kind)}`} key=${type.kind}
    class=${`option${type.why ? " off" : ""}`}
      aria-selected=${String(!type.why && i === at)} aria-disabled=${type.why ? "true" : undefined}
      title=${type.why ? `${nameOf(type.kind)} ${type.why}` : type.kind}
      onClick=${() => {
        if (!type.why) setAt(i);
      }} onDblClick=${() => {
        if (!type.why) add();
      }}>
    <${Icon} name=${nameOf(type.kind)} /><b>${nameOf(type.kind)}</b><span>${type.help}</span>
    </div>`;
  return html`<${Dialog} title="Add Display" close=${close} submit=${add} wide>
    <div class="options" role="listbox" tabindex="0" aria-label="Display types" data-first
      ref=${list} onKeyDown=${key}
        aria-activedescendant=${chosen ? `add-${nameOf(chosen.kind)}` : undefined}>
      <div role="group" aria-label="Shown here">${shown.map(option)}</div>
      <div role="group" aria-labelledby="add-others"><div class="group"
        id="add-others">Not shown here: each ${others[0]?.why || ""}</div>
        ${others.map(option)}</div>
    </div>
    <label class="line">Name <input ref=${name} placeholder=${chosen ? nameOf(chosen.kind) : ""}
      spellcheck=${false} autocomplete="off" maxlength="200" /></label>
    <div class="buttons end">
      <button type="submit" class="main">Add</button>
      <button type="button" onClick=${close}>Cancel</button>
    </div>
  </${Dialog}>`;
}
