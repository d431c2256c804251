// What an overlay renders to, as the checks look at it: documents by kind, pods by workload.

export class Fleet {
  // `documents` as read from YAML; `root` is the project's folder.
  constructor(documents, root, overlay) {
    this.documents = documents;
    this.root = root;
    this.overlay = overlay;
    this.workloads = documents
      .filter((one) => one.spec?.template?.spec?.containers)
      .map((one) => new Workload(one));
    this.containers = this.workloads.flatMap((workload) =>
      workload.pod.containers.map((container) => ({ workload, container })));
  }

  ofKind(kind) {
    return this.documents.filter((one) => one.kind === kind);
  }

  named(kind, name) {
    return this.ofKind(kind).find((one) => one.metadata.name === name);
  }

  workload(component) {
    const found = this.workloads.find((one) => one.labels['app.kubernetes.io/component'] === component);
    if (!found) throw new Error(`there is no workload with the component ${component}`);
    return found;
  }

  // The variables that all services of the fleet have in common.
  get environment() {
    return this.environmentOf(this.workload('vehicle').pod.containers[0]);
  }

  // Variables as a container gets them; what another object gives it is undefined where it is not
  // there, and null where only the cluster knows it.
  environmentOf(container) {
    const all = {};
    for (const from of container.envFrom ?? []) {
      const map = this.named('ConfigMap', from.configMapRef?.name);
      for (const [key, value] of Object.entries(map?.data ?? {})) all[(from.prefix ?? '') + key] = value;
    }
    for (const one of container.env ?? []) {
      const key = one.valueFrom?.configMapKeyRef;
      if (key) all[one.name] = this.named('ConfigMap', key.name)?.data?.[key.key];
      else all[one.name] = one.value ?? null;
    }
    return all;
  }
}

export class Workload {
  constructor(document) {
    this.name = `${document.kind}/${document.metadata.name}`;
    this.document = document;
    this.replicas = document.spec.replicas ?? 1;
    this.labels = document.spec.template.metadata?.labels ?? {};
    this.annotations = document.spec.template.metadata?.annotations ?? {};
    this.pod = document.spec.template.spec;
  }

  // The labels of each of its pods: a StatefulSet adds one for each.
  get podLabels() {
    if (this.document.kind !== 'StatefulSet') return [this.labels];
    return Array.from({ length: this.replicas }, (_, index) => ({
      ...this.labels,
      'statefulset.kubernetes.io/pod-name': `${this.document.metadata.name}-${index}`,
      'apps.kubernetes.io/pod-index': String(index),
    }));
  }

  portNamed(name) {
    return this.pod.containers.flatMap((one) => one.ports ?? []).find((port) => port.name === name);
  }
}

// Whether labels are what a selector with matchLabels and matchExpressions asks for.
export function matches(selector, labels) {
  const has = Object.entries(selector.matchLabels ?? {}).every(([key, value]) => labels[key] === value);
  const expressions = {
    In: ({ key, values }) => values.includes(labels[key]),
    NotIn: ({ key, values }) => !values.includes(labels[key]),
    Exists: ({ key }) => key in labels,
    DoesNotExist: ({ key }) => !(key in labels),
  };
  return has && (selector.matchExpressions ?? []).every((one) => expressions[one.operator](one));
}

// The workloads of which at least one pod is selected.
export function selected(fleet, selector) {
  return fleet.workloads.filter((one) => one.podLabels.some((labels) => matches(selector, labels)));
}

// "250m" and "64Mi" as cores and MiB.
export function cores(quantity) {
  const text = String(quantity);
  return text.endsWith('m') ? Number(text.slice(0, -1)) / 1000 : Number(text);
}
export function mebibytes(quantity) {
  const found = /^([0-9.]+)(Ki|Mi|Gi)$/.exec(String(quantity));
  return found ? Number(found[1]) * { Ki: 1 / 1024, Mi: 1, Gi: 1024 }[found[2]] : NaN;
}
