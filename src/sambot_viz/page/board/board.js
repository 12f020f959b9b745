// @ts-check
/* The teacher's board: a row for each student, live; who is stuck for longest comes first. */

import { html, render, useEffect, useRef, useState } from "../vendor/preact.js";
import { ago, presence, problems, sorted, summary } from "./rows.js";

/**
 * @typedef {import("./rows.js").BoardRow} BoardRow
 * @typedef {{lesson: string, steps: number, points: number, folder: string,
 *   trouble: string, reaches: boolean}} Class reaches: whether orders reach the students' pages
 */

/** The server's limit is the same [characters]. */
const LONGEST = 300;
/** A lost connection that the browser gives up is tried again after so long [ms]. */
const AGAIN = 5000;
/** How often the times are counted again [ms]. */
const TICK = 10000;

/** Have something done; gives why it was not. @param {string} what @param {Record<string, any>} fields */
async function ask(what, fields) {
  try {
    const address = `${what}?${new URLSearchParams(fields)}`;
    const answer = await fetch(address, { headers: { "Sambot-Class": "1" } });
    return answer.ok ? "" : await answer.text();
  } catch {
    return "the server of the class does not answer";
  }
}

/** What the server tells, from now on. */
function useBoard() {
  const [known, setKnown] = useState(/** @type {Class | null} */ (null));
  const [rows, setRows] = useState(/** @type {BoardRow[]} */ ([]));
  const [live, setLive] = useState(true);
  /** The server's clock is ahead of this one by so much [s]. */
  const ahead = useRef(0);
  const [, tick] = useState(0);
  useEffect(() => {
    /** @type {EventSource} */
    let source;
    let timer = 0;
    const open = () => {
      source = new EventSource("rows");
      source.onmessage = ({ data }) => {
        const said = JSON.parse(data);
        setLive(true);
        if (said.rows) {
          ahead.current = said.now - Date.now() / 1000;
          setKnown(said);
          setRows(said.rows);
        } else if ("trouble" in said) {
          setKnown((/** @type {Class | null} */ before) => before && { ...before, ...said });
        } else {
          const { row } = said;
          setRows((/** @type {BoardRow[]} */ before) => [
            ...before.filter(({ number }) => number !== row.number),
            row,
          ]);
        }
      };
      source.onerror = () => {
        setLive(false);
        if (source.readyState === EventSource.CLOSED) timer = setTimeout(open, AGAIN);
      };
    };
    open();
    const ticking = setInterval(() => tick((/** @type {number} */ n) => n + 1), TICK);
    return () => {
      source.close();
      clearTimeout(timer);
      clearInterval(ticking);
    };
  }, []);
  return { known, rows: sorted(rows), live, now: Date.now() / 1000 + ahead.current };
}

function Board() {
  const { known, rows, live, now } = useBoard();
  const [looked, setLooked] = useState(0);
  const [writes, setWrites] = useState(/** @type {BoardRow | "all" | null} */ (null));
  const [said, setSaid] = useState("");
  const [collects, setCollects] = useState(false);
  if (!known) return html`<p class="soft">${live ? "…" : "The class does not answer."}</p>`;
  const show = async (/** @type {number} */ number) => setSaid(await ask("show", { number }));
  const shown = rows.find((row) => row.shown);
  const look = rows.find(({ number }) => number === looked);
  const collect = async () => {
    setCollects(true);
    setSaid(await saved("class.zip"));
    setCollects(false);
  };
  return html`<main class="board">
    <header>
      <h1>${known.lesson}</h1>
      <p class="soft" role="status">${summary(rows, known.steps)}</p>
      <div class="buttons">
        ${known.reaches && html`<button onClick=${() => setWrites("all")}>Message to all</button>`}
        ${shown && html`<button onClick=${() => show(0)}>${`Stop showing ${shown.name}`}</button>`}
        <a class="button" href="class.csv" download>CSV</a>
        <button disabled=${collects} onClick=${collect}
          title="Files, progress and grade of each student">
          ${collects ? "Collecting…" : "Collect all (zip)"}</button>
      </div>
      ${!live && html`<p class="error" role="alert">The connection is lost; trying again…</p>`}
      ${known.trouble && html`<p class="error" role="alert">${known.trouble}</p>`}
      ${said && html`<p class="error" role="alert">${said}</p>`}
    </header>
    ${
      rows.length
        ? html`<${Table} rows=${rows} known=${known} now=${now} look=${setLooked}
            write=${setWrites} show=${show} />`
        : html`<p class="empty">Nobody is here yet. ${
            known.reaches
              ? "Students open the address of the class, which sambot-viz has printed"
              : "A row comes with each student who starts a server or opens the lesson"
          }; their files come into ${known.folder}.</p>`
    }
    ${look && html`<${Look} row=${look} show=${show} write=${setWrites} close=${() => setLooked(0)} />`}
    ${writes && html`<${Write} to=${writes} close=${() => setWrites(null)} />`}
  </main>`;
}

/** Save a file that takes long to make; gives why it was not made. @param {string} name */
async function saved(name) {
  try {
    const answer = await fetch(name);
    if (!answer.ok) return await answer.text();
    const link = document.createElement("a");
    link.href = URL.createObjectURL(await answer.blob());
    link.download = name;
    link.click();
    URL.revokeObjectURL(link.href);
    return "";
  } catch {
    return "the server of the class does not answer";
  }
}

/** @param {{rows: BoardRow[], known: Class, now: number, look: (number: number) => void,
 *   write: (row: BoardRow) => void, show: (number: number) => void}} props */
function Table({ rows, known, now, look, write, show }) {
  return html`<table>
    <thead><tr><th>Student</th><th>Step</th><th>Problems</th><th>Tries</th><th>Points</th>
      <th>Last change</th><th>No progress for</th><th>Pages</th><th></th></tr></thead>
    <tbody>${rows.map((row) => {
      const done = row.step > known.steps;
      return html`<tr key=${row.number} class=${done ? "done" : row.stuck ? "stuck" : ""}>
        <td class="who">${
          known.reaches
            ? html`<button class="flat" onClick=${() => look(row.number)}
                title=${`Look at what ${row.name} does`}>${row.name}</button>`
            : row.name
        }</td>
        <td class="step" title=${row.title}><span class="soft">
          ${done ? "" : `${row.step}/${known.steps} `}</span>${row.title}</td>
        <td class=${row.errors ? "error" : "soft"} data-name="Problems" title=${row.first}>
          ${problems(row)}</td>
        <td data-name="Tries">${row.tries}</td>
        <td data-name="Points">${row.points}</td>
        <td data-name="Last change">${ago(row.changed, now)}</td>
        <td data-name="No progress for">${done ? "–" : ago(row.since, now)}</td>
        <td data-name="Pages" class=${row.pages && !row.server ? "" : "soft"}>${presence(row)}</td>
        <td class="do">
          ${
            known.reaches &&
            html`<button onClick=${() => look(row.number)}>Look</button>
              <button aria-pressed=${row.shown} onClick=${() => show(row.shown ? 0 : row.number)}>
                ${row.shown ? "Shown to all" : "Show to all"}</button>
              <button onClick=${() => write(row)}>Message</button>`
          }
          ${row.trouble && html`<p class="error">${row.trouble}</p>`}
        </td></tr>`;
    })}</tbody></table>`;
}

/** The page of a student, as it is now; nothing can be changed in it.
 * @param {{row: BoardRow, show: (number: number) => void, write: (row: BoardRow) => void,
 *   close: () => void}} props */
function Look({ row, show, write, close }) {
  const address = `../student/${row.number}/`;
  /** @type {Ref<HTMLDialogElement>} */
  const dialog = useRef(null);
  useEffect(() => dialog.current.showModal(), []);
  return html`<dialog class="look" ref=${dialog} onClose=${close}>
    <header><b>${row.name}</b><span class="soft">${row.first || row.title}</span>
      <button onClick=${() => show(row.shown ? 0 : row.number)}>
        ${row.shown ? "Stop showing" : "Show to all"}</button>
      <button onClick=${() => write(row)}>Message</button>
      <a class="button" href=${address} target="_blank">In a tab</a>
      <button onClick=${() => dialog.current.close()}>Close</button></header>
    <iframe key=${row.number} src=${address} title=${`The page of ${row.name}`}></iframe>
  </dialog>`;
}

/** @param {{to: BoardRow | "all", close: () => void}} props */
function Write({ to, close }) {
  const [why, setWhy] = useState("");
  /** @type {Ref<HTMLDialogElement>} */
  const dialog = useRef(null);
  useEffect(() => dialog.current.showModal(), []);
  const send = async (/** @type {Event} */ event) => {
    event.preventDefault();
    /** @type {HTMLTextAreaElement | null} */
    const field = dialog.current.querySelector("textarea");
    const number = to === "all" ? 0 : to.number;
    const said = await ask("say", { number, text: field?.value || "" });
    if (said) setWhy(said);
    else dialog.current.close();
  };
  return html`<dialog class="write" ref=${dialog} onClose=${close}><form onSubmit=${send}>
    <label>${to === "all" ? "Message to all" : `Message to ${to.name}`}
      <textarea required rows="3" maxlength=${LONGEST}></textarea></label>
    ${why && html`<p class="error" role="alert">${why}</p>`}
    <div class="buttons"><button class="main">Send</button>
      <button type="button" onClick=${() => dialog.current.close()}>Cancel</button></div>
  </form></dialog>`;
}

render(html`<${Board} />`, document.body);
