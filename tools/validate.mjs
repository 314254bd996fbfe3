// Runs the glTF validator over files named on standard input, one a line, and prints a line of JSON for each:
// {"file": …, "issues": [{"code": …, "severity": 0, "message": …, "pointer": …}, …]}, or "refused" with the reason.
// Usage: node validate.mjs FOLDER_OF_THE_PACKAGE < list
import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { dirname, resolve } from 'node:path';

const { validateBytes } = createRequire(import.meta.url)(resolve(process.argv[2]));
for (const file of readFileSync(0, 'utf8').split('\n').filter((line) => line !== '')) {
    const beside = async (uri) => new Uint8Array(readFileSync(resolve(dirname(file), decodeURIComponent(uri))));
    try {
        const report = await validateBytes(new Uint8Array(readFileSync(file)), {
            uri: file,
            maxIssues: 0,
            externalResourceFunction: beside,
        });
        const issues = report.issues.messages.filter(({ severity }) => severity <= 1);
        console.log(JSON.stringify({ file, issues }));
    } catch (refused) {
        console.log(JSON.stringify({ file, refused: String(refused) }));
    }
}
