// Whether every selector finds pods: one that finds none is no error to Kubernetes, and does nothing.
import { matches, selected } from './fleet.mjs';

// Pods of other namespaces are none of ours to find.
function policySelectors(policy) {
  const peers = [...(policy.spec.ingress ?? []), ...(policy.spec.egress ?? [])]
    .flatMap((rule) => rule.from ?? rule.to ?? []);
  return [policy.spec.podSelector, ...peers.filter((one) => !one.namespaceSelector).map((one) => one.podSelector)]
    .filter(Boolean);
}

function selectorsOf(document) {
  switch (document.kind) {
    case 'Service':
      return [{ matchLabels: document.spec.selector }];
    case 'PodDisruptionBudget':
      return [document.spec.selector];
    case 'NetworkPolicy':
      return policySelectors(document);
    default:
      return [];
  }
}

export function selectorsMatch(fleet) {
  const complaints = [];
  for (const document of fleet.documents) {
    for (const selector of selectorsOf(document)) {
      if (selected(fleet, selector).length > 0) continue;
      complaints.push(`${document.kind}/${document.metadata.name} selects no pod: ${JSON.stringify(selector)}`);
    }
  }
  for (const workload of fleet.workloads) {
    const own = [workload.document.spec.selector ?? {},  // a Job gets its own
      ...(workload.pod.topologySpreadConstraints ?? []).map((one) => one.labelSelector)];
    for (const selector of own.filter((one) => !matches(one, workload.labels))) {
      complaints.push(`${workload.name} does not select its own pods: ${JSON.stringify(selector)}`);
    }
  }
  return complaints;
}

// A Service or budget that takes in pods of two workloads mixes what has nothing in common.
export function selectorsAreNarrow(fleet) {
  return [...fleet.ofKind('Service'), ...fleet.ofKind('PodDisruptionBudget')].flatMap((document) => {
    const found = selected(fleet, selectorsOf(document)[0]);
    if (found.length < 2) return [];
    return [`${document.kind}/${document.metadata.name} selects ${found.map((one) => one.name).join(' and ')}`];
  });
}

// An eviction budget for each workload, and no more.
export function budgetsCover(fleet) {
  return fleet.workloads.flatMap((workload) => {
    const budgets = fleet.ofKind('PodDisruptionBudget')
      .filter((one) => matches(one.spec.selector, workload.labels));
    return budgets.length === 1 ? [] : [`${workload.name} has ${budgets.length} PodDisruptionBudgets`];
  });
}
