// What the kernel sends as bytes.

/**
 * The float32 numbers of a message, whether it brings an ArrayBuffer or a view of one.
 * @param {ArrayBuffer | ArrayBufferView} bytes
 */
export function floats(bytes) {
  const view = ArrayBuffer.isView(bytes) ? bytes : new DataView(bytes);
  const { buffer, byteOffset, byteLength } = view;
  return new Float32Array(buffer.slice(byteOffset, byteOffset + byteLength));
}

/**
 * Show a PNG in an image, in place of the one before; nothing for none.
 * @param {HTMLImageElement} image
 * @param {ArrayBufferView | ArrayBuffer | null} [png]
 */
export function showPNG(image, png) {
  if (image.src.startsWith("blob:")) URL.revokeObjectURL(image.src);
  if (!png?.byteLength) return;
  image.src = URL.createObjectURL(new Blob([/** @type {BlobPart} */ (png)], { type: "image/png" }));
}
