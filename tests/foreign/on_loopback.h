/* What every Cyclone program of the tests starts with: a participant on loopback alone. */
#pragma once

#include <dds/dds.h>

/* The entity; ends the program with exit code 2 where it is an error. */
dds_entity_t Made(dds_entity_t entity);

/* A participant in a domain that this process has on loopback. */
dds_entity_t ParticipantOnLoopback(dds_domainid_t domain);
