// Makes the files beside it with the original encoders, from the sample assets/thin-bar.glb:
//   npm install @gltf-transform/core@4 @gltf-transform/extensions@4 @gltf-transform/functions@4 draco3dgltf@1.5 meshoptimizer@1
//   node make.mjs ../../../../../assets/thin-bar.glb
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS, EXTMeshoptCompression, KHRDracoMeshCompression } from '@gltf-transform/extensions';
import { meshopt } from '@gltf-transform/functions';
import { MeshoptDecoder, MeshoptEncoder } from 'meshoptimizer';
import draco3d from 'draco3dgltf';
import { writeFileSync } from 'node:fs';

const sample = process.argv[2];
await MeshoptEncoder.ready;
await MeshoptDecoder.ready;
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS).registerDependencies({
    'meshopt.encoder': MeshoptEncoder,
    'meshopt.decoder': MeshoptDecoder,
    'draco3d.encoder': await draco3d.createEncoderModule(),
    'draco3d.decoder': await draco3d.createDecoderModule(),
});

// Whole files.
for (const level of ['medium', 'high']) {
    const document = await io.read(sample);
    await document.transform(meshopt({ encoder: MeshoptEncoder, level }));
    await io.write(`meshopt-${level}.glb`, document);
}
// What the original decoder makes of them: the numbers of all vertices in their order, and the indices, as one checksum.
const checksums = {};
function checksum(...arrays) {
    let sum = 0xcbf29ce484222325n;
    for (const array of arrays) {
        for (const byte of new Uint8Array(array.buffer, array.byteOffset, array.byteLength)) {
            sum = BigInt.asUintN(64, (sum ^ BigInt(byte)) * 0x100000001b3n);
        }
    }
    return sum.toString(16);
}
for (const method of ['EDGEBREAKER', 'SEQUENTIAL']) {
    const document = await io.read(sample);
    document.createExtension(KHRDracoMeshCompression).setRequired(true).setEncoderOptions({
        method: KHRDracoMeshCompression.EncoderMethod[method],
        encodeSpeed: method === 'EDGEBREAKER' ? 0 : 5,
        decodeSpeed: method === 'EDGEBREAKER' ? 0 : 5,
    });
    const name = `draco-${method.toLowerCase()}`;
    await io.write(`${name}.glb`, document);
    const primitive = (await io.read(`${name}.glb`)).getRoot().listMeshes()[0].listPrimitives()[0];
    const array = (semantic) => Float32Array.from(primitive.getAttribute(semantic).getArray());
    checksums[name] = checksum(array('POSITION'), array('NORMAL'), Uint32Array.from(primitive.getIndices().getArray()));
}
writeFileSync('draco-checksums.json', JSON.stringify(checksums, null, 1) + '\n');

// Single streams of every mode, version and filter, with what the original decoder makes of them.
const document = await io.read(sample);
const primitive = document.getRoot().listMeshes()[0].listPrimitives()[0];
const positions = primitive.getAttribute('POSITION').getArray();
const normals = primitive.getAttribute('NORMAL').getArray();
const indices = Uint32Array.from(primitive.getIndices().getArray());
const streams = [];
const base64 = (bytes) => Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength).toString('base64');
function add(name, mode, filter, count, stride, bytes) {
    const decoded = new Uint8Array(count * stride);
    MeshoptDecoder.decodeGltfBuffer(decoded, count, stride, bytes, mode, filter);
    streams.push({ name, mode, filter, count, stride, bytes: base64(bytes), decoded: base64(decoded) });
}
const asBytes = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
const n = 300;
// Bytes without any pattern, in which nothing is short.
let state = 1;
const noise = Uint8Array.from({ length: 16 * 45 }, () => ((state = (state * 48271) % 2147483647) >> 8) & 255);
for (const version of [0, 1]) {
    const encode = (bytes, count, stride, level) =>
        MeshoptEncoder.encodeVertexBufferLevel(bytes, count, stride, level, version);
    for (const level of [0, 3]) {
        const name = `version ${version}, level ${level}`;
        add(`positions, ${name}`, 'ATTRIBUTES', 'NONE', n, 12, encode(asBytes(positions.slice(0, 3 * n)), n, 12, level));
        add(`noise, ${name}`, 'ATTRIBUTES', 'NONE', 45, 16, encode(noise, 45, 16, level));
    }
    const wide = new Uint8Array(40 * 256).map((_, i) => (i % 256 < 200 ? i >> 8 : noise[i % noise.length]));
    add(`wide, version ${version}`, 'ATTRIBUTES', 'NONE', 40, 256, encode(wide, 40, 256, 2));
    const shorts = Uint16Array.from({ length: 4 * 100 }, (_, i) => 65535 & ((i >> 2) * (i % 4 < 2 ? 700 : 3)));
    add(`ramps, version ${version}`, 'ATTRIBUTES', 'NONE', 100, 8, encode(asBytes(shorts), 100, 8, 3));
}
const pad = (array) => Float32Array.from({ length: 4 * 96 }, (_, i) => (i % 4 < 3 ? array[3 * (i >> 2) + (i % 4)] : 1));
const turns = new Float32Array(4 * 96);
for (let i = 0; i < 96; i++) {
    const q = [Math.sin(i), Math.cos(3 * i), Math.sin(2 * i + 1), Math.cos(i) - 0.5];
    turns.set(q.map((x) => x / Math.hypot(...q)), 4 * i);
}
const colors = Float32Array.from({ length: 4 * 96 }, (_, i) => (i * 37 % 101) / 101);
const filtered = [
    ['OCTAHEDRAL', 4, MeshoptEncoder.encodeFilterOct(pad(normals), 96, 4, 8)],
    ['OCTAHEDRAL', 8, MeshoptEncoder.encodeFilterOct(turnsAsNormals(), 96, 8, 12)],
    ['QUATERNION', 8, MeshoptEncoder.encodeFilterQuat(turns, 96, 8, 12)],
    ['EXPONENTIAL', 12, MeshoptEncoder.encodeFilterExp(positions.slice(0, 288), 96, 12, 15)],
    ['COLOR', 4, MeshoptEncoder.encodeFilterColor(colors, 96, 4, 8)],
    ['COLOR', 8, MeshoptEncoder.encodeFilterColor(colors, 96, 8, 12)],
];
function turnsAsNormals() {
    const n = turns.slice();
    for (let i = 0; i < 96; i++) {
        const length = Math.hypot(n[4 * i], n[4 * i + 1], n[4 * i + 2]);
        for (let k = 0; k < 3; k++) n[4 * i + k] /= length;
    }
    return n;
}
for (const [filter, stride, bytes] of filtered) {
    add(`${filter} ${stride}`, 'ATTRIBUTES', filter, 96, stride, MeshoptEncoder.encodeVertexBuffer(bytes, 96, stride));
}
for (const stride of [2, 4]) {
    const ordered = stride === 4 ? indices.slice(0, 600) : Uint16Array.from(indices.slice(0, 600));
    const shuffled = Uint32Array.from({ length: 300 }, (_, i) => (i * 7919) % 100003);
    const triples = stride === 4 ? shuffled : Uint16Array.from(shuffled);
    for (const [name, list] of [['ordered', ordered], ['shuffled', triples]]) {
        const bytes = asBytes(list);
        add(`${name} triangles ${stride}`, 'TRIANGLES', 'NONE', list.length, stride, MeshoptEncoder.encodeIndexBuffer(bytes, list.length, stride));
        add(`${name} indices ${stride}`, 'INDICES', 'NONE', list.length, stride, MeshoptEncoder.encodeIndexSequence(bytes, list.length, stride));
    }
}
writeFileSync('meshopt-streams.json', JSON.stringify(streams, null, 1) + '\n');
console.log(streams.map((s) => `${s.name}: ${s.bytes.length}`).join('\n'));
