/* reporter.mjs: the tests' results as lines for people, and as JUnit for tools/summary.py in the file FACET_JUNIT, with
 * ctest's words for what passed and failed.
 *
 * SPDX-License-Identifier: MIT */
import { writeFileSync } from "node:fs";

const escape = text => text.replace(/[<>&"]/g, c => `&#${c.charCodeAt(0)};`).replace(/[^\t\n\x20-\uffff]/g, "?");

function junit(cases) {
  const count = status => cases.filter(one => one.status === status).length;
  const rows = cases.map(
    ({ name, status, seconds, text }) =>
      `  <testcase name="${escape(name)}" classname="explorer" time="${seconds}" status="${status}">` +
      (status === "fail" ? `<failure>${escape(text)}</failure>` : status === "notrun" ? "<skipped/>" : "") +
      "</testcase>\n",
  );
  return (
    `<?xml version="1.0" encoding="UTF-8"?>\n<testsuite name="explorer" tests="${cases.length}" ` +
    `failures="${count("fail")}" skipped="${count("notrun")}" disabled="0">\n${rows.join("")}</testsuite>\n`
  );
}

export default async function* report(source) {
  const cases = [];
  for await (const { type, data } of source) {
    if (
      type === "test:diagnostic" &&
      !/^(tests|suites|pass|fail|cancelled|skipped|todo|duration_ms) /.test(data.message)
    )
      yield `       ${data.message}\n`;
    if (type !== "test:pass" && type !== "test:fail") continue;
    if (data.nesting > 0 || data.name.endsWith(".test.mjs")) {
      if (
        type === "test:fail" &&
        data.name.endsWith(".test.mjs") &&
        data.details.error?.failureType !== "subtestsFailed"
      )
        cases.push({
          name: data.name,
          status: "fail",
          seconds: 0,
          text: String(data.details.error?.cause ?? data.details.error),
        });
      if (data.name.endsWith(".test.mjs")) continue;
    }
    const seconds = (data.details.duration_ms / 1000).toFixed(2);
    const status = data.skip !== undefined ? "notrun" : type === "test:pass" ? "run" : "fail";
    const cause = data.details.error?.cause ?? data.details.error;
    const text = status === "fail" ? String(cause?.stack ?? cause) : "";
    cases.push({ name: data.name, status, seconds, text });
    yield `${{ run: "ok    ", fail: "FAILED", notrun: "skip  " }[status]} ${data.name} (${seconds} s)\n${text && `${text}\n`}`;
  }
  if (process.env.FACET_JUNIT) writeFileSync(process.env.FACET_JUNIT, junit(cases));
  const failed = cases.filter(one => one.status === "fail").length;
  yield `${cases.length - failed} passed, ${failed} failed\n`;
}
