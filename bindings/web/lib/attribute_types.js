// How numbers of the C interface are called here.

export const DOMAINS = ['vertex', 'corner', 'face', 'shot'];
export const SEMANTICS = ['generic', 'texture coordinate', 'normal', 'tangent', 'colour', 'velocity', 'material', 'group', 'index'];
export const TYPES = [
  ['binary32', Float32Array],
  ['u8', Uint8Array],
  ['u16', Uint16Array],
  ['i32', Int32Array],
  ['u8 normalised', Uint8Array],
  ['u16 normalised', Uint16Array],
];

/** The kind of array that holds an attribute's values. */
export function arrayType(attribute) {
  return TYPES.find(([name]) => name === attribute.type)[1];
}
