// Other models of the notebook.

/**
 * The models that these references name, once they are made: also those of pythreejs, whose
 * objects are those of three.js.
 * @param {Given} given
 * @param {string[]} references
 * @returns {Promise<Model[]>}
 */
export async function resolve({ model, host }, references) {
  const find = (/** @type {string} */ id) =>
    model.widget_manager?.get_model?.(id) ?? host.getModel(`anywidget:${id}`);
  const models = await Promise.all(
    references.map((reference) => find(reference.slice("IPY_MODEL_".length))),
  );
  await Promise.all(models.map((one) => one.initPromise));
  return models;
}
