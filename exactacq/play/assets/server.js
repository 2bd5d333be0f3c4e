/** Requests to the server that this page came from. */

/** What went wrong, in words; `told` is all that the server says. */
export class Trouble extends Error {
  constructor(told) {
    super(told.cure ? `${told.error}; ${told.cure}` : told.error);
    this.told = told;
  }
}

async function answered(path, options) {
  let response;
  try {
    response = await fetch(path, options);
  } catch {
    throw new Trouble({ error: "the server does not answer: is exactacq play still running?" });
  }
  if (response.ok) return response;
  throw new Trouble(await response.json().catch(() => ({ error: `the server says ${response.status}` })));
}

const query = (path, parameters) => `${path}?${new URLSearchParams(parameters)}`;
const sent = (value) => ({
  method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(value ?? {}),
});

export const ask = async (path, parameters = {}) => (await answered(query(path, parameters))).json();
export const send = async (path, value) => (await answered(path, sent(value))).json();
export const receive = async (path, value, parameters = {}) => (await answered(query(path, parameters), sent(value))).blob();

export async function upload(path, file, parameters) {
  const headers = { "Content-Type": "application/octet-stream" };
  return (await answered(query(path, parameters), { method: "POST", headers, body: file })).json();
}
