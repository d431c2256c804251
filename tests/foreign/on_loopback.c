#include "tests/foreign/on_loopback.h"

#include <stdio.h>
#include <stdlib.h>

static const char kOnLoopback[] =
    "<CycloneDDS><Domain><General><Interfaces>"
    "<NetworkInterface name=\"lo\" multicast=\"true\"/>"
    "</Interfaces></General></Domain></CycloneDDS>";

dds_entity_t Made(dds_entity_t entity) {
  if (entity < 0) {
    fprintf(stderr, "Cyclone DDS: %s\n", dds_strretcode(entity));
    exit(2);
  }
  return entity;
}

dds_entity_t ParticipantOnLoopback(dds_domainid_t domain) {
  Made(dds_create_domain(domain, kOnLoopback));
  return Made(dds_create_participant(domain, NULL, NULL));
}
