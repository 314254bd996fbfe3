// Makes rich.gltf: a small document that uses much of what glTF can hold, spelled in ways that encoders would not.
//   node make-rich.mjs
import { writeFileSync } from 'node:fs';

const chunks = [];
const bufferViews = [];
const accessors = [];
let length = 0;
function view(bytes, more = {}) {
    while (length % 4) { chunks.push(Buffer.alloc(1)); length++; }
    bufferViews.push({ buffer: 0, byteOffset: length, byteLength: bytes.byteLength, ...more });
    chunks.push(Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength));
    length += bytes.byteLength;
    return bufferViews.length - 1;
}
function accessor(bufferView, componentType, type, count, more = {}) {
    accessors.push({ bufferView, componentType, count, type, ...more });
    return accessors.length - 1;
}
const VERTICES = { target: 34962 };
const INDICES = { target: 34963 };

// A sheet of 4 x 4 vertices with a hill.
const n = 4;
const sheet = [];
for (let j = 0; j < n; j++) for (let i = 0; i < n; i++) sheet.push([i / 3, j / 3, i === 1 && j === 1 ? 0.5 : 0]);
const faces = [];
for (let j = 0; j + 1 < n; j++) for (let i = 0; i + 1 < n; i++) {
    const a = j * n + i;
    faces.push(a, a + 1, a + n + 1, a, a + n + 1, a + n);
}
const indices = accessor(view(Uint16Array.from(faces), INDICES), 5123, 'SCALAR', faces.length);
const floats = (list, type, more) =>
    accessor(view(Float32Array.from(list.flat()), VERTICES), 5126, type, list.length, more);
const bounds = { min: [0, 0, 0], max: [1, 1, 0.5] };
const positions = (at = (p) => p, more = bounds) => floats(sheet.map(at), 'VEC3', more);
const up = sheet.map(() => [0, 0, 1]);

// Quantized and interleaved: positions of 16 bits, a normal of 8, texture coordinates of 16, 16 bytes a vertex.
const packed = Buffer.alloc(16 * 16);
sheet.forEach(([x, y, z], v) => {
    [x, y, z].forEach((c, k) => packed.writeUInt16LE(Math.round(65535 * c), 16 * v + 2 * k));
    packed.writeInt8(127, 16 * v + 10);
    [x, y].forEach((c, k) => packed.writeUInt16LE(Math.round(65535 * c), 16 * v + 12 + 2 * k));
});
const interleaved = view(packed, { byteStride: 16, ...VERTICES });
const quantized = accessor(interleaved, 5123, 'VEC3', 16, { normalized: true, min: [0, 0, 0], max: [65535, 65535, 32768] });
const small = accessor(interleaved, 5120, 'VEC3', 16, { byteOffset: 8, normalized: true });
const coordinates = accessor(interleaved, 5123, 'VEC2', 16, { byteOffset: 12, normalized: true });

const strip = accessor(view(Uint8Array.from([0, 4, 1, 5, 2, 6, 3, 7]), INDICES), 5121, 'SCALAR', 8);
const line = accessor(view(Uint8Array.from([0, 1, 2, 3]), INDICES), 5121, 'SCALAR', 4);
const joints = accessor(view(Uint8Array.from(sheet.flatMap(() => [0, 1, 0, 0])), VERTICES), 5121, 'VEC4', 16);
const weights = accessor(
    view(Uint8Array.from(sheet.flatMap(([x]) => [255 - Math.round(255 * x), Math.round(255 * x), 0, 0])), VERTICES),
    5121, 'VEC4', 16, { normalized: true });
const tangents = floats(sheet.map(() => [1, 0, 0, -1]), 'VEC4');
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const inverse = accessor(view(Float32Array.from([...identity, ...identity])), 5126, 'MAT4', 2);

// Sparse: a hill put on a sheet, and a morph target that is nothing but one displacement.
const sparse = (at, values) => ({
    count: at.length,
    indices: { bufferView: view(Uint16Array.from(at)), componentType: 5123 },
    values: { bufferView: view(Float32Array.from(values.flat())) },
});
const hill = positions(undefined, { min: [0, 0, 0], max: [1, 1, 0.75], sparse: sparse([10], [[0.5, 0.5, 0.75]]) });
const lift = floats(sheet.map(([x]) => [0, 0, x]), 'VEC3', { min: [0, 0, 0], max: [0, 0, 1] });
const tilt = floats(sheet.map(() => [-0.5, 0, 0]), 'VEC3');
accessors.push({ componentType: 5126, count: 16, type: 'VEC3', min: [0, 0, 0], max: [0, 1, 0],
    sparse: sparse([3], [[0, 1, 0]]) });
const poke = accessors.length - 1;

const times = accessor(view(Float32Array.from([0, 1])), 5126, 'SCALAR', 2, { min: [0], max: [1] });
const turns = accessor(view(Float32Array.from([0, 0, 0, 1, 0, 0, 1, 0])), 5126, 'VEC4', 2);
const moods = accessor(view(Float32Array.from([0, 0, 1, 0.5])), 5126, 'SCALAR', 4);
const places = accessor(view(Float32Array.from([0, 0, 0, 3, 0, 0])), 5126, 'VEC3', 2);
const pixel = 'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==';
// Spelled as it stands: JSON.stringify would write 1, 100000 and a rounded number.
const spelled = (text) => `@${text}@`;

const document = {
    asset: { version: '2.0', generator: 'by hand', extras: { ten: spelled('10.0'), exponent: spelled('1e5'), digits: spelled('0.10'),
        large: spelled('123456789012345678901234567890') } },
    extensionsUsed: ['KHR_mesh_quantization', 'KHR_lights_punctual', 'KHR_materials_unlit', 'EXT_mesh_gpu_instancing', 'ACME_unknown'],
    extensionsRequired: ['KHR_mesh_quantization'],
    extensions: { KHR_lights_punctual: { lights: [{ type: 'point', intensity: spelled('4.0') }] }, ACME_unknown: { z: 1, a: [null, true] } },
    scene: 0,
    scenes: [{ name: 'main', nodes: [0, 6, 9, 10, 11] }, { name: 'other', nodes: [12] }],
    nodes: [
        { name: 'root', scale: [2, 1, spelled('0.50')], rotation: [0, 0, 0.6, 0.8], translation: [5, 0, 0], children: [1, 2, 3, 4] },
        { name: 'mirrored', mesh: 0, scale: [-1, 1, 1] },
        { name: 'again', mesh: 0, translation: [0, 2, 0], extras: { keep: 'me' } },
        { name: 'eye', camera: 0 },
        { name: 'lamp', extensions: { KHR_lights_punctual: { light: 0 } } },
        { name: 'joint 1', translation: [1, 0, 0] },
        { name: 'joint 0', children: [5, 8] },
        { name: 'lost', mesh: 4 },
        { name: 'leaf' },
        { name: 'skinned', mesh: 1, skin: 0, translation: [99, 99, 99] },
        { name: 'morphed', mesh: 2, weights: [0, 0], extensions: { EXT_mesh_gpu_instancing: { attributes: { TRANSLATION: places } } } },
        { name: 'flat', mesh: 3, scale: [1, 0, 1] },
        { name: 'elsewhere', mesh: 5, translation: [-3, 0, 0] },
    ],
    cameras: [{ type: 'perspective', perspective: { yfov: spelled('0.80'), znear: 0.01 } }],
    meshes: [
        { name: 'quantized', primitives: [
            { attributes: { NORMAL: small, POSITION: quantized, TEXCOORD_0: coordinates }, indices, material: 0 },
            { attributes: { POSITION: quantized, NORMAL: small }, indices: strip, mode: 5, extras: [spelled('1.0')] },
            { attributes: { POSITION: quantized }, indices: line, mode: 1 },
        ] },
        { name: 'skinned', primitives: [{ attributes: { POSITION: positions(), NORMAL: floats(up, 'VEC3'), TANGENT: tangents,
            JOINTS_0: joints, WEIGHTS_0: weights, _WEAR: floats(sheet.map(([x]) => [x]), 'SCALAR') }, indices, material: 1 }] },
        { name: 'morphed', weights: [0.5, 0], extras: { targetNames: ['lift', 'poke'] }, primitives: [{
            attributes: { POSITION: hill, NORMAL: floats(up, 'VEC3') }, indices,
            targets: [{ POSITION: lift, NORMAL: tilt }, { POSITION: poke }] }] },
        { name: 'flattened', primitives: [{ attributes: { POSITION: positions() }, indices }] },
        { name: 'unused', primitives: [{ attributes: { POSITION: positions(([x, y, z]) => [x, y, z]) }, indices }] },
        { name: 'of the other scene', primitives: [{ attributes: { POSITION: positions() }, indices,
            extensions: { ACME_unknown: { attributes: 7 } } }] },
    ],
    skins: [{ joints: [6, 5], inverseBindMatrices: inverse, skeleton: 6 }],
    animations: [{ name: 'wave', samplers: [{ input: times, output: turns }, { input: times, output: moods }],
        channels: [{ sampler: 0, target: { node: 5, path: 'rotation' } }, { sampler: 1, target: { node: 10, path: 'weights' } }] }],
    materials: [
        { name: 'picture', pbrMetallicRoughness: { baseColorTexture: { index: 0 }, roughnessFactor: spelled('1.0') } },
        { name: 'plain', extensions: { KHR_materials_unlit: {} }, extras: null },
    ],
    textures: [{ source: 0, sampler: 0 }],
    samplers: [{ wrapS: 33071 }],
    images: [{ name: 'pixel', uri: `data:image/png;base64,${pixel}` }],
    accessors,
    bufferViews,
    buffers: [],
};
document.buffers.push({ byteLength: length, uri: 'data:application/octet-stream;base64,' + Buffer.concat(chunks).toString('base64') });
const text = JSON.stringify(document, null, 1).replace(/"@([^@"]*)@"/g, '$1');
writeFileSync('rich.gltf', text + '\n');
