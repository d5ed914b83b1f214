// Validates glTF files by gltf-validator of npm. Usage: node validate_gltf.js MODULES FILE...
"use strict";
const fs = require("fs");
const path = require("path");

const [modules, ...files] = process.argv.slice(2);
const validator = require(path.join(modules, "gltf-validator"));

async function validate(file) {
  const {issues} = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
  for (const message of issues.messages) {
    console.log(`${file}: ${message.pointer}: ${message.code}: ${message.message}`);
  }
  console.log(`${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings`);
  return issues.numErrors + issues.numWarnings;
}

if (files.length === 0) throw new Error("no glTF file is given");
Promise.all(files.map(validate)).then((faults) => {
  process.exitCode = faults.some((count) => count > 0) ? 1 : 0;
});
