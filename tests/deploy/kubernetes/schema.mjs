// Every document against the schema Kubernetes has for its kind, as kubernetes-models carries them.
// Those schemas allow fields they do not know, as the API server drops them without a word: what a
// validator never looked at is such a field.

// A value that notes which of its fields, by their paths, have been read.
function watched(value, path, read) {
  if (value === null || typeof value !== 'object') return value;
  const parts = new Map();
  return new Proxy(value, {
    get(target, key, receiver) {
      const part = Reflect.get(target, key, receiver);
      if (typeof key !== 'string' || !Object.hasOwn(target, key)) return part;
      read.add(`${path}/${key}`);
      if (part === null || typeof part !== 'object') return part;
      if (!parts.has(key)) parts.set(key, watched(part, `${path}/${key}`, read));
      return parts.get(key);
    },
  });
}

function unread(value, path, read) {
  if (value === null || typeof value !== 'object') return [];
  return Object.keys(value).flatMap((key) =>
    read.has(`${path}/${key}`) ? unread(value[key], `${path}/${key}`, read) : [`${path}/${key}`]);
}

function nothingIn(value, path) {
  if (value === null) return [path];
  if (typeof value !== 'object') return [];
  return Object.keys(value).flatMap((key) => nothingIn(value[key], `${path}/${key}`));
}

function modelOf(document, require) {
  const [version, group] = String(document.apiVersion).split('/').reverse();
  try {
    return require(['kubernetes-models', group, version].filter(Boolean).join('/'))[document.kind];
  } catch {
    return undefined;
  }
}

function complaintsOf(document, require) {
  const Model = modelOf(document, require);
  if (!Model) return [`Kubernetes has no ${document.kind} in ${document.apiVersion}`];
  const read = new Set();
  const errors = [];
  try {
    watched(new Model(document), '', read).validate();
  } catch (error) {
    if (!error.errors) throw error;
    errors.push(...error.errors.map((one) => `${one.instancePath} ${one.message}`));
  }
  const unknown = unread(document, '', read).map((path) => `${path} is no field of it`);
  const empty = nothingIn(document, '').map((path) => `${path} has no value`);
  return [...errors, ...unknown, ...empty];
}

export function schemas(fleet, require) {
  return fleet.documents.flatMap((document) =>
    complaintsOf(document, require).map((text) => `${document.kind}/${document.metadata?.name}: ${text}`));
}
