// Completion, hover and diagnostics of VS Code's language server for JSON, with the schema found through `$schema`.
import { spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import languageService from "vscode-json-languageservice";

const { TextDocument, getLanguageService } = languageService;

const [house, program, scratch] = process.argv.slice(2);
const folder = join(scratch, "styles");
mkdirSync(folder);
const made = spawnSync(program, ["copy", "education", join(folder, "copied.json")], { encoding: "utf8" });
if (made.status !== 0) throw new Error(made.stderr);

const service = getLanguageService({
  schemaRequestService: async (uri) => readFileSync(fileURLToPath(uri), "utf8"),
  workspaceContext: { resolveRelativePath: (path, base) => new URL(path, base).toString() },
  clientCapabilities: {
    textDocument: { completion: { completionItem: { documentationFormat: ["markdown", "plaintext"], snippetSupport: true } } },
  },
});
service.configure({ validate: true, allowComments: false, schemas: [] });

let checks = 0;
const failures = [];
const check = (claim, holds, seen) => {
  checks += 1;
  if (!holds) failures.push(`${claim}\n    seen: ${JSON.stringify(seen)}`);
};

const open = (name, text) => {
  const document = TextDocument.create(pathToFileURL(join(folder, name)).toString(), "json", 1, text);
  return [document, service.parseJSONDocument(document)];
};
const diagnostics = async (name, text) => {
  const [document, json] = open(name, text);
  const found = await service.doValidation(document, json, { schemaValidation: "error", trailingCommas: "error", comments: "error" });
  return found.map(({ range, message, severity }) => ({ at: `${range.start.line + 1}:${range.start.character + 1}`, message, severity }));
};
// A style with its `$schema`, and the place of the bar in it.
const style = (body) => `{ "$schema": "style-v1.json", ${body} }`;
const complete = async (body) => {
  const text = style(body);
  const [document, json] = open("s.json", text.replace("|", ""));
  const list = await service.doComplete(document, document.positionAt(text.indexOf("|")), json);
  return list.items;
};
const labels = (items) => items.map((item) => item.label.replace(/^"|"$/g, ""));
const hover = async (body) => {
  const text = style(body);
  const [document, json] = open("s.json", text.replace("|", ""));
  const found = await service.doHover(document, document.positionAt(text.indexOf("|")), json);
  return found?.contents.join("\n") ?? "";
};
const has = async (claim, body, due, never = []) => {
  const seen = labels(await complete(body));
  check(claim, due.every((word) => seen.includes(word)) && !never.some((word) => seen.includes(word)), seen);
};
const entry = (shader, properties) => `"shaders": [{ "name": "a", "shader": "${shader}", "properties": { ${properties} } }]`;
const notDrawn = ["curvature", "ssaoPost", "dofPost", "outlinePost", "opacity"];

// Completion.
await has("keys of a style", `|`, ["camera", "geometry", "mapping", "shaders", "lights", "extends", "version"], ["transparency"]);
await has("shaders by name", `"shaders": [{ "name": "a", "shader": | }]`, ["basic", "toon", "unlit"], notDrawn);
await has("shaders by name, within quotes", `"shaders": [{ "name": "a", "shader": "t|" }]`, ["basic", "toon", "unlit"], notDrawn);
await has("keys of an entry", `"shaders": [{ | }]`, ["name", "shader", "properties"]);
await has("entries by shader", `"shaders": [|]`, ["basic", "toon", "unlit"], notDrawn);
await has("properties of toon", entry("toon", "|"), ["base_color", "hull_size", "steps", "shadow_color"], ["smoothness", ...notDrawn]);
await has("properties of basic", entry("basic", "|"), ["base_color", "smoothness", "metallic"], ["hull_size", ...notDrawn]);
await has("properties of a base's entry", `"extends": "b.json", "shaders": [{ "name": "a", "properties": { | } }]`, ["hull_size", "smoothness"], notDrawn);
await has("words of levels", entry("toon", `"levels": |`), ["floor", "centre", "full"]);
await has("lengths with units", entry("toon", `"hull_size": |`), ["2pt", "3r", "1.5A", "2mm", "0pt"]);
await has("sources of colour", entry("toon", `"base_color": |`), ["element", "chain", "residue", "#rrggbb", "[r, g, b]"]);
await has("selectors", `"mapping": { | }`, ["atom", "connector", "*", "atom[element=O]"], ["ribbon", "surface", "mesh", "post_effects"]);
await has("targets of a rule", `"mapping": { "atom": | }`, ["basic", "toon", "unlit", "null"], notDrawn);
await has("targets of any selector", `"mapping": { "atom[name=C?]": | }`, ["basic", "toon", "unlit", "null"], notDrawn);
await has("lights", `"lights": [|]`, ["directional light", "point light", "ambient light"]);
await has("words of a light", `"lights": [{ "shadow": | }]`, ["none", "hard", "soft"]);
await has("words of orient", `"camera": { "orient": | }`, ["default", "principal"]);
await has("true and false", `"camera": { "orthographic": | }`, ["true", "false"]);
await has("examples of a number", `"camera": { "fov": | }`, ["15", "35", "100"]);
{
  const [document, json] = open("new.json", "");
  const list = await service.doComplete(document, document.positionAt(0), json);
  check("an empty file has no schema yet", !labels(list.items).includes("camera"), labels(list.items));
  const item = (await complete(`"mapping": { | }`)).find((item) => item.label === "atom");
  check("a selector comes with its sentence", /spheres/.test(JSON.stringify(item?.documentation)), item);
  check("a selector inserts its value", item?.textEdit?.newText.startsWith('"atom": '), item?.textEdit);
  const toon = (await complete(`"shaders": [{ "name": "a", "shader": | }]`)).find((item) => item.label === '"toon"');
  check("a shader comes with its sentence", /Comic shading/.test(JSON.stringify(toon?.documentation)), toon);
  const light = (await complete(`"lights": [|]`)).find((item) => item.label === "directional light");
  check("a light is inserted whole", /"position": \[/.test(light?.textEdit?.newText ?? ""), light?.textEdit);
}

// Hover.
const texts = [
  ["a property", entry("toon", `"hull|_size": "2pt"`), /Width of the outline.*Default: `"0pt"`/s],
  ["a key of camera", `"camera": { "f|ov": 35 }`, /field of view.*from 1 to 150 \(degrees\)\. Default: `35`/s],
  ["a shader", `"shaders": [{ "name": "a", "shader": "to|on" }]`, /Comic shading/],
  ["a section", `"ligh|ts": []`, /What shines on the scene/],
  ["a selector of the list", `"mapping": { "at|om": "toon" }`, /spheres/],
  ["any selector", `"mapping": { "atom[na|me=C?]": "toon" }`, /entry of shaders/],
];
for (const [what, body, due] of texts) {
  const text = await hover(body);
  check(`hover on ${what}`, due.test(text), text);
}
{
  const [document, json] = open("s.json", style(`"camera": { "bgcolor": "#102030" }`));
  const colors = await service.findDocumentColors(document, json);
  check("colours have swatches", colors.length === 1, colors);
}

// The looks, and a type that is not drawn yet: nothing, or a warning.
for (const name of readdirSync(join(house, "styles")).filter((name) => name !== "style-v1.json")) {
  const found = (await diagnostics(name, readFileSync(join(house, "styles", name), "utf8"))).filter(({ severity }) => severity === 1);
  check(`no mistake in ${name}`, found.length === 0, found);
}
{
  const found = await diagnostics("s.json", style(`"mapping": { "ribbon[chain=a]": "toon" }`));
  const ok = found.length > 0 && found.every(({ severity, message }) => severity === 2 && /not drawn by this version yet/.test(message));
  check("a type that is not drawn is a warning", ok, found);
}

{
  const found = await diagnostics("s.json", `// why\n${style(`"camera": { "fov": 30, },`)}`);
  check("comments and trailing commas are fine", found.length === 0, found);
}

// The same mistakes at the same places as the program finds them.
const broken = [
  `"camra": {}`,
  `"camera": 3`,
  `"camera": { "fovv": 30 }`,
  `"camera": { "fov": "wide", "zoom": 0 }`,
  `"camera": { "orthographic": "yes" }`,
  `"camera": { "bgcolor": "whit" }`,
  `"camera": { "bgcolor": [255, 255] }`,
  `"camera": { "bgcolor": [255, 256, 0] }`,
  `"camera": { "bgcolor": [255, "0", 0] }`,
  `"camera": { "position": [1, 2] }`,
  `"camera": { "orient": "Principal" }`,
  `"version": 2`,
  `"geometry": { "atom": "vdv" }`,
  `"geometry": { "bond_radius": "-1A" }`,
  `"geometry": { "bond_radius": true }`,
  `"geometry": { "scale": 1e300 }`,
  `"transparency": { "k": 2.5 }`,
  `"lights": {}`,
  `"lights": [{ "type": "sun" }, { "strength": 1.5 }, 7]`,
  `"mapping": { "atm": "basic" }`,
  `"mapping": { "atom[part=a]": "basic" }`,
  `"mapping": { "atom[element=O": "basic" }`,
  `"mapping": { "atom": 3 }`,
  `"mapping": { "post_effects": "dofPost" }`,
  `"shaders": [{ "name": "a" }]`,
  `"shaders": [{ "shader": "toon" }]`,
  `"shaders": [{ "name": "a", "shader": "tone" }]`,
  `"shaders": [{ "name": "a", "shader": "toon", "propertys": {} }]`,
  entry("toon", `"hul_size": "2pt"`),
  entry("toon", `"hull_size": "2px"`),
  entry("toon", `"steps": 999, "levels": "center", "base_color": "elements"`),
  entry("toon", `"shadow_color": "whit"`),
  entry("basic", `"hull_size": "2pt"`),
  `"shaders": [{ "name": "a", "shader": "toon", "properties": [] }]`,
];
for (const body of broken) {
  // On lines of their own, so that a place is more than a column.
  const text = `{\n  "$schema": "style-v1.json",\n  ${body}\n}`;
  const file = join(folder, "broken.json");
  writeFileSync(file, text);
  const answer = spawnSync(program, ["render", "water", "-s", file, "-o", join(scratch, "out.png")], { encoding: "utf8" });
  const places = (list) => [...new Set(list)].sort().join(" ");
  const loader = [...answer.stderr.matchAll(/broken\.json:(\d+:\d+)/g)].map((match) => match[1]);
  const found = (await diagnostics("broken.json", text)).filter(({ severity }) => severity !== 2);
  const same = loader.length > 0 && places(loader) === places(found.map(({ at }) => at));
  check(`the same places in ${body}`, same, { loader, found });
}

console.log(`${checks - failures.length} of ${checks} claims hold`);
for (const failure of failures) console.log(`  ${failure}`);
process.exit(failures.length === 0 ? 0 : 1);
