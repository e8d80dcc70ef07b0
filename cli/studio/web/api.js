// Requests to the program. An answer without a result is thrown as StudioError with its messages.

/** @typedef {{severity: string, id: string, file: string, line: number, what: string, advice: string}} Message */

export class StudioError extends Error {
  /** @param {Message[]} messages */
  constructor(messages) {
    super(messages.map((m) => m.what).join("; "));
    this.messages = messages;
  }
  has(id) {
    return this.messages.some((m) => m.id === id);
  }
}

const make_message = (id, what, advice) => ({ severity: "error", id, file: "", line: 0, what, advice });

/** @param {string} name @param {object} body @returns {Promise<any>} */
export async function call(name, body) {
  let answer;
  try {
    const response = await fetch("api/" + name, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
    if (response.status === 413) throw new StudioError([make_message("studio.too-large", "the request is larger than 8 MB", "use the command line")]);
    if (response.status === 403) throw new StudioError([make_message("studio.refused", "the program refused the request", "open the address that bough studio printed last")]);
    answer = await response.json();
  } catch (error) {
    if (error instanceof StudioError) throw error;
    throw new StudioError([make_message("studio.gone", "the program does not answer", "start bough studio again and open its address; texts here are kept until then")]);
  }
  if (!answer.result) throw new StudioError(answer.messages);
  return answer.result;
}

/** A question about files, answered by a process of its own. */
export const ask = (what, more = {}) => call("ask", { what, ...more });

/** Lines of the commands that ran, for "copy commands". @type {string[]} */
export const history = [];

const kLine = /^(?:(.*?):(?:(\d+):)?(?:(\d+):)? )?(error|warning|note): (.*?)(?: \[([\w.-]+)\])?$/;

/** Messages among the lines that a command printed. @param {string} text @returns {Message[]} */
export function parse_messages(text) {
  const messages = [];
  for (const line of text.split("\n")) {
    const found = kLine.exec(line);
    if (!found || /^\s*"/.test(line)) continue;  // JSON repeats them
    const [, file, row, , severity, rest, id] = found;
    const [what, ...advice] = rest.split("; ");
    messages.push({ severity, id: id ?? "", file: file ?? "", line: Number(row ?? 0), what, advice: advice.join("; ") });
  }
  return messages;
}

/**
 * @typedef {{verb: string, files: string[], options?: string[][], before?: number}} Command  before: time of the output
 *   when the command started, as the list of files has it
 * @typedef {{job: number, line: string, request: Command}} Job
 * @typedef {{code: number, output: string, line: string, messages: Message[]}} Outcome
 * @typedef {(output: string, job: {stop: () => Promise<any>}) => void} Progress  called with all output so far
 */

/**
 * Runs a command of the program until it ends.
 * @param {Command} command
 * @param {Progress} on_progress
 * @returns {Promise<Outcome>}
 */
export async function run_job({ options = [], ...more }, on_progress = () => {}) {
  const { job, line } = await call("start", { options, ...more });
  history.push(line);
  return follow_job({ job, line }, on_progress);
}

/**
 * Follows a command that runs, started by this page or another, until it ends.
 * @param {{job: number, line: string}} started
 * @param {Progress} on_progress
 * @returns {Promise<Outcome>}
 */
export async function follow_job({ job, line }, on_progress = () => {}) {
  const handle = { stop: () => call("stop", { job }) };
  let output = "", from = 0;
  on_progress(output, handle);
  for (;;) {
    const state = await call("job", { job, from });
    output += state.output;
    from = state.total;
    on_progress(output, handle);
    if (!state.running) return { code: state.code, output, line, messages: parse_messages(output) };
    await new Promise((done) => setTimeout(done, 200));
  }
}

/** Commands that run. @returns {Promise<Job[]>} */
export const list_jobs = async () => (await call("jobs", {})).jobs;

/** The command that runs for a file, if there is one. @param {string} file  @param {string[]} verbs */
export const find_job = async (file, verbs) => (await list_jobs()).find(({ request }) => verbs.includes(request.verb) && request.files[0] === file);
