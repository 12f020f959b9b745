// @ts-check
/* Add: a display by its type or by its topic, and a name. */

import { html, useRef, useState } from "../vendor/preact.js";
import { forTopic, makeDisplay } from "../panels/selected_display.js";
import { selected, useRow } from "../state.js";
import { PANEL, TopicTree } from "./add_by_topic.js";
import { displayTypes, nameOf, TypeList } from "./add_by_type.js";
import { Dialog } from "./dialog.js";

/** The tabs, as RViz calls them. */
const TABS = ["By display type", "By topic"];

/** @param {{close: () => void}} props */
export function AddDisplay({ close }) {
  const [tab, setTab] = useState(0);
  const [kind, setKind] = useState(() => displayTypes()[0]?.kind || "");
  const row = useRow(selected.use()[PANEL] || "none");
  const name = useRef(/** @type {any} */ (null));
  const byTopic = tab === 1;
  /** @type {string | undefined} */
  const chosen = byTopic ? row?.topic && row.display : kind;
  const add = () => {
    if (!chosen) return;
    const { value } = name.current;
    close();
    if (byTopic) makeDisplay("add-topic", forTopic(row?.topic, chosen, value), true);
    else makeDisplay("add", [chosen, value], true);
  };
  return html`<${Dialog} title="Add Display" close=${close} submit=${add} wide>
    <${DialogTabs} at=${tab} go=${setTab} />
    <div class="tabbed" role="tabpanel" id="add-panel" aria-label=${TABS[tab]}>
      ${
        byTopic
          ? html`<${TopicTree} add=${add} />`
          : html`<${TypeList} at=${kind} go=${setKind} add=${add} />`
      }
    </div>
    <label class="line">Name <input ref=${name} placeholder=${chosen ? nameOf(chosen) : ""}
      spellcheck=${false} autocomplete="off" maxlength="200" /></label>
    <div class="buttons end">
      <button type="submit" class="main" disabled=${!chosen}
        title=${chosen ? undefined : "Select a topic or a display of it"}>Add</button>
      <button type="button" onClick=${close}>Cancel</button>
    </div>
  </${Dialog}>`;
}

/** @param {{at: number, go: (tab: number) => void}} props */
function DialogTabs({ at, go }) {
  /** @param {Key} event */
  const key = (event) => {
    const last = TABS.length - 1;
    const to = /** @type {Record<string, number>} */ ({
      ArrowRight: at < last ? at + 1 : 0,
      ArrowLeft: at > 0 ? at - 1 : last,
      Home: 0,
      End: last,
    })[event.key];
    if (to === undefined) return;
    go(to);
    /** @type {HTMLElement} */ (event.currentTarget.children[to]).focus();
    event.preventDefault();
  };
  return html`<div class="tabs" role="tablist" aria-label="Choose" onKeyDown=${key}>
    ${TABS.map(
      (title, i) => html`<button type="button" role="tab" key=${title}
        aria-selected=${String(i === at)} aria-controls=${i === at ? "add-panel" : undefined}
        tabindex=${i === at ? 0 : -1} onClick=${() => go(i)}>${title}</button>`,
    )}
  </div>`;
}
