// Checks what one overlay, or the campaign, renders to; kubernetes.sh runs it.
// Usage: node check.mjs ROOT OVERLAY RENDERED MODULES
// A line for each check, "ok NAME" or "FAILED NAME", and what is wrong below it.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import * as campaign from './campaign.mjs';
import * as environment from './environment.mjs';
import { Fleet } from './fleet.mjs';
import * as network from './network.mjs';
import * as pods from './pods.mjs';
import * as references from './references.mjs';
import * as scenario from './scenario.mjs';
import * as schema from './schema.mjs';
import * as selectors from './selectors.mjs';

const [root, overlay, rendered, modules] = process.argv.slice(2);
const require = createRequire(join(resolve(modules), 'package.json'));
const documents = require('yaml').parseAllDocuments(readFileSync(rendered, 'utf8')).map((one) => one.toJS());
const fleet = new Fleet(documents, root, overlay);

const ofACampaign = {
  schema: () => schema.schemas(fleet, require),
  selectors_match: selectors.selectorsMatch,
  references: references.referencesExist,
  files_mounted: references.filesAreMounted,
  files_the_projects: references.filesAreTheProjects,
  arguments_filled: environment.argumentsAreFilled,
  silent: network.deniedByDefault,
  bounded: pods.bounded,
  shut_in: pods.shutIn,
  images_pinned: pods.imagesArePinned,
  every_shard_once: campaign.everyShardOnce,
  tried_again: campaign.triedAgain,
  results_stay: campaign.resultsStay,
  plan_mounted: campaign.planIsMounted,
  one_core_a_thread: campaign.oneCoreAThread,
  apart: campaign.isApart,
};

const ofAFleet = {
  schema: () => schema.schemas(fleet, require),
  selectors_match: selectors.selectorsMatch,
  selectors_narrow: selectors.selectorsAreNarrow,
  budgets: selectors.budgetsCover,
  references: references.referencesExist,
  files_mounted: references.filesAreMounted,
  files_the_projects: references.filesAreTheProjects,
  variables_known: environment.variablesAreKnown,
  variables_agree: environment.variablesAgree,
  orders_sealed: environment.ordersCanBeSealed,
  arguments_filled: environment.argumentsAreFilled,
  domain_ports_open: network.domainPortsAreOpen,
  other_ports_shut: network.otherPortsAreShut,
  denied_by_default: network.deniedByDefault,
  dns_open: network.namesCanBeAsked,
  servers_found: network.serversAreFound,
  health_reached: network.healthIsReached,
  probed: pods.probed,
  bounded: pods.bounded,
  shut_in: pods.shutIn,
  images_pinned: pods.imagesArePinned,
  fleet: pods.fleetIsPut,
  planned_for: pods.plannedForIsRequested,
  places: scenario.everyVehicleHasAPlace,
  scenario_as_written: scenario.scenarioIsAsWritten,
};

const checks = overlay === 'campaign' ? ofACampaign : ofAFleet;

// What is so broken that a check cannot look at it is wrong, too.
function complaintsOf(check) {
  try {
    return check(fleet);
  } catch (error) {
    return [`cannot be looked at: ${error.message}`];
  }
}

let failed = 0;
for (const [name, check] of Object.entries(checks)) {
  const complaints = complaintsOf(check);
  console.log(`${complaints.length === 0 ? 'ok     ' : 'FAILED '} ${overlay}.${name}`);
  complaints.slice(0, 8).forEach((text) => console.log(`    ${text}`));
  if (complaints.length > 8) console.log(`    and ${complaints.length - 8} more`);
  failed += complaints.length > 0 ? 1 : 0;
}
process.exit(failed > 0 ? 1 : 0);
