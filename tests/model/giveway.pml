/* The right of way of 2 or 3 vehicles at one crossing, for SPIN: all sequences in which beacons are
 * lost, late, out of order or duplicated, and in which vehicles die and come back, at any tick.
 *
 * Correspondence with the code (services/vehicle, services/types):
 *
 *   here            there
 *   Hear            PeerTable::Take, IsFresh, IsLost                            peer_table.cc
 *   PrecedesByKey   PrecedesByKey, HasPriority: by both keys as published       beacon.h
 *   Look            RelatePeers, CrossingWith: conflict, grants, has_priority   peer_relation.cc
 *   IsThroughFirst  IsThroughFirst, of ONE_LANE too                             timing.cc
 *   UpdateFresh     UpdateEncounters, Begins, IsOver, Holds, SecondMustStop     encounter.cc
 *   MayCross        MayCrossBefore                                              encounter.cc
 *   UpdateLost      UpdateLost, Holds of a lost peer                            encounter.cc
 *   Claimed         ClaimOf, FreeBefore, KeepClear                              claim.cc, decision_rules.cc
 *   Listen          DetectMovers, NearestEcho; the rule UnidentifiedMotion       mover_watch.cc, decision_rules.cc
 *   Remember, Say   KeepOrder, Remember, GivesWayTo, CanGiveWay, MakeBeacon     waiting.cc, vehicle.cc, decide.cc
 *   Move            World::Step; of the dead: watchdog, removal of the body     sim_world
 *
 * Time is ticks, all vehicles step in each. In tick k a brain knows any one of the beacons of ticks
 * k-1 .. k-AGE, or none: so they get lost, come late, out of order and twice, and the model needs
 * neither sequence number nor boot epoch. How long a peer stays lost is free too.
 *
 * Geometry is one line of places a vehicle: FAR (out of range), COMING, NEARER, GATE (stands before
 * the zone), RUNUP rolling places from which it can still stop, ZONE, PAST. From standstill it takes
 * RUNUP ticks to where it can no longer stop: more than the age limit of a beacon, as in the real fleet.
 *
 * Not in the model, so not proven here: steering and everything it is for (detours, backing out, the
 * inherited priority, blocked_by, clears), traffic lights, queues in one lane, three zones instead of
 * one, speeds other than none and full, pose errors, ultrasonics that miss a body, stale ranges, spoofed
 * or corrupted beacons, duplicate ids, restarts of the world. Ultrasonics detect exactly the bodies from
 * the gate to the end of the zone. The virtual fleet tests these things; it proves nothing.
 *
 * Switches: N vehicles; AGE ticks a beacon is trusted; CRASHES, RESTARTS in all; ONCE: no vehicle
 * comes again; EVEN: one speed; STALL: a rolling vehicle may be slow; ONE_STEP: through the zone in
 * one tick; ONE_LANE: the zone is a one-lane section, driven through from both ends; NO_CLAIMS,
 * NO_AGREEMENT: one of the two lines of defence is missing; ONLY_EXCLUSION: the other safety
 * properties are not checked; WEATHER: losses end eventually, and WHO must pass; the injected
 * defects. runs.txt says which are tried together, and what SPIN must find.
 */
#ifndef N
#define N 2
#endif
#ifndef AGE
#define AGE 2 /* ticks: beacon_age_limit */
#endif
#define RUNUP (AGE + 1)
#ifndef AGED_AT_MOST
#define AGED_AT_MOST 2 /* ticks of waiting that are counted; 0: no ageing */
#endif
#define AGEING_LIMIT 1 /* ticks of waiting beyond which they count */
#define AgedTicks(i) (waited[i] > AGEING_LIMIT -> waited[i] : 0)
#ifndef CRASHES
#define CRASHES 0
#endif
#ifndef RESTARTS
#define RESTARTS 0
#endif

/* Places. */
#define FAR 0
#define COMING 1
#define NEARER 2
#define GATE 3
#define LAST (GATE + RUNUP) /* one step further lies the zone */
#define ZONE (LAST + 1)
#define ZONE_END (LAST + 2)
#define PAST (LAST + 3)
#define GONE (LAST + 4) /* a dead body that was taken away; as a place that was said: silence */

#define IsNear(p) ((p) >= GATE && (p) <= LAST)
#define Rolls(p) ((p) > GATE && (p) <= LAST)
#define InZone(p) ((p) == ZONE || (p) == ZONE_END)
#define IsHeardBody(p) ((p) >= GATE && (p) <= ZONE_END)
/* At the fastest, from a place that was said. */
#define StepsToZone(p) ((p) <= NEARER -> NEARER - (p) + RUNUP + 1 : ZONE - (p))
#define StepsThrough(p) (PAST - (p))

/* What is heard of a peer in a tick: the age of its beacon, or one of these. */
#define LOST 0            /* nothing fresh */
#define LOST_LONG (AGE + 1) /* for so long that it had the time to pass */
#define IsFresh(a) ((a) >= 1 && (a) <= AGE)

/* In a one-lane section nothing is steered round. */
#ifdef ONE_LANE
#define IsSteeredRound false
#else
#define IsSteeredRound true
#endif

#define NOBODY 0 /* in gives_way_to; others are index + 1 */

typedef Beacon {
  byte place;
  byte gives_way_to;
  byte waited; /* the part of the priority key that changes */
};

/* The world. */
byte place[N];
bool up[N];   /* the process lives */
bool go[N];   /* the motor command of this tick */
bool fast[N]; /* the cruise-speed bucket */
byte crashes = CRASHES;
byte restarts = RESTARTS;
bool good = false; /* the radio loses nothing any more */

/* The air: what was said, [sender * AGE + age - 1]. */
Beacon said[N * AGE];
#define Said(j, a) said[(j) * AGE + (a) - 1]

/* The brains. */
#define AT(i, j) ((i) * N + (j))
bool meets[N * N];    /* Encounter::active, the latch */
bool holds[N * N];    /* Encounter::holds */
bool released[N * N]; /* Encounter::released */
bool stood[N * N];    /* last heard standing and second: no conflict */
byte waited[N];       /* ticks */
bool let_pass[N];     /* a peer with priority has passed since it waits */
byte order[N];        /* the waited part of the own key, as published */
byte gives_way[N];    /* said at the end of this tick */
bool under_way[N];    /* this tick: encounters are active, and were in the tick before */
bool rests[N];        /* this tick: no encounter, no waiting: what it waited is forgotten */

/* Scratch: heard lives from Hear to the end of Decide, the rest within one step; 0 between. */
byte heard[N];
byte v, w, j, p, a;
bool conflict, has_priority, standing, grants, through;
bool clear, deaf, waits, met, meets_any, held;

/* The safety properties. SPIN names the one that is broken. */
bool two_in_zone;  /* exclusion: never two bodies in the zone, dead or alive */
bool out_of_order; /* order: no vehicle enters before a near peer that it hears and that has
                    * priority, unless that peer waits for a third */
bool unfrozen;     /* frozen: during encounters the published priority changes only once its
                    * vehicle has let another pass, and stands before the zone */
bool unlatched;    /* latch: a stop for a peer lasts until that has passed or given way */

#include "defects.pml"

inline Look(i) {
  p = Said(j, heard[j]).place;
  a = TrustedAge(heard[j]);
  standing = p == GATE;
  has_priority = HasPriority(Said(j, heard[j]).waited, j, order[i], i);
  conflict = IsConflict(p) && !(IsSteeredRound && standing && !has_priority);
  grants = Grants(Said(j, heard[j]).gives_way_to == i + 1 || (standing && !has_priority));
  through = !conflict || (IsNear(place[i]) && IsThroughFirst(place[i], p, a))
}

/* It stands and gives way to a third one: meanwhile it is not waited for. */
#if N == 3
#define MayCross(i, j_)                               \
  (Said(j_, heard[j_]).place == GATE &&               \
   Said(j_, heard[j_]).gives_way_to != NOBODY && \
   Said(j_, heard[j_]).gives_way_to != i + 1)
#else
#define MayCross(i, j_) false
#endif

inline UpdateFresh(i) {
  Look(i);
  released[AT(i, j)] = false;
  let_pass[i] = let_pass[i] || (waited[i] > 0 && meets[AT(i, j)] && has_priority && p == FAR);
  meets[AT(i, j)] = (meets[AT(i, j)] -> p != FAR : conflict && !through);
  stood[AT(i, j)] = meets[AT(i, j)] && !conflict;
  held = holds[AT(i, j)];
  holds[AT(i, j)] = meets[AT(i, j)] && IsNear(place[i]) &&
      (has_priority -> !MayCross(i, j) &&
                         (Latched(holds[AT(i, j)]) ||
                          (conflict && SecondMustStop(IsHeardBody(p) || place[i] == LAST)))
                   : !(grants || through) && (Latched(holds[AT(i, j)]) || place[i] == LAST));
  CheckLatch(i);
  if
  :: meets[AT(i, j)] && has_priority && !(place[i] == LAST && MayCross(i, j)) &&
     (gives_way[i] == NOBODY || p >= Said(gives_way[i] - 1, heard[gives_way[i] - 1]).place) ->
     gives_way[i] = j + 1 /* the nearest */
  :: else
  fi;
  if
  :: place[i] == LAST && Claimed(p, a) -> go[i] = false
  :: else
  fi
}

inline UpdateLost(i) {
  released[AT(i, j)] = meets[AT(i, j)] &&
      (released[AT(i, j)] || (heard[j] == LOST_LONG && MayRelease(clear)));
  holds[AT(i, j)] = meets[AT(i, j)] && !released[AT(i, j)] && HoldsForLost(
      holds[AT(i, j)] || (place[i] == LAST && !stood[AT(i, j)]))
}

inline Update(i) {
  met = met || meets[AT(i, j)];
  if
  :: IsFresh(heard[j]) -> UpdateFresh(i)
  :: else -> UpdateLost(i)
  fi;
  meets_any = meets_any || meets[AT(i, j)];
  if
  :: holds[AT(i, j)] && !IGNORES_AGREEMENT -> waits = true; go[i] = false
  :: else
  fi
}

/* A body explained by a fresh beacon says nothing new; any other that moves is a reason to stop. */
inline Listen(i) {
  clear = true;
  deaf = false;
  for (j : 0 .. N - 1) {
    if
    :: j != i && IsHeardBody(place[j]) ->
       clear = false;
       deaf = deaf || (place[j] > GATE && !IsExplained(i, j))
    :: else
    fi
  }
}

inline Remember(i) {
  if
  :: waits && place[i] == GATE && waited[i] < AGED_AT_MOST -> waited[i]++
  :: else
  fi;
  under_way[i] = AGED_AT_MOST > 0 && met && meets_any;
  rests[i] = AGED_AT_MOST > 0 && ForgetsWaiting(!meets_any && !waits)
}

/* By PrecedesByKey, the correct priority, whatever defect is injected. */
inline CheckOrder(i) {
  for (j : 0 .. N - 1) {
    if
    :: CHECKS_AGREEMENT && j != i && place[i] == LAST && go[i] && IsFresh(heard[j]) ->
       out_of_order = IsNear(Said(j, heard[j]).place) && !MayCross(i, j) &&
                      PrecedesByKey(Said(j, heard[j]).waited, j, order[i], i);
       assert(!out_of_order)
    :: else
    fi
  }
}

inline CheckLatch(i) {
  unlatched = CHECKS_AGREEMENT && held && !holds[AT(i, j)] && meets[AT(i, j)] && IsNear(place[i]) &&
              (has_priority -> conflict && !MayCross(i, j) : !(grants || through));
  assert(!unlatched)
}

inline Decide(i) {
  d_step {
    go[i] = true;
    gives_way[i] = NOBODY;
    waits = false;
    met = false;
    meets_any = false;
    Listen(i);
    for (j : 0 .. N - 1) {
      if
      :: HearsAsPeer(i, j) -> Update(i)
      :: else
      fi
    }
    if
    :: deaf && IsNear(place[i]) -> go[i] = false; waits = true
    :: else
    fi;
    Remember(i);
    CheckOrder(i);
    for (j : 0 .. N - 1) { heard[j] = LOST }
    j = 0; p = 0; a = 0; conflict = 0; has_priority = 0; standing = 0; grants = 0; through = 0;
    clear = 0; deaf = 0; waits = 0; met = 0; meets_any = 0; held = 0
  }
}

#define IsOnAir(j) (Said(j, 1).place != GONE || Said(j, AGE).place != GONE)

/* The youngest beacon of v's that i believes in this tick is of any age, or there is none. */
inline Hear(i) {
  if
  :: !(good && IsOnAir(w)) && meets[AT(i, w)] -> heard[w] = LOST_LONG
  :: !(good && (IsOnAir(w) || meets[AT(i, w)])) -> heard[w] = LOST
  :: Said(w, 1).place != GONE -> heard[w] = 1
#if AGE >= 2
  :: Said(w, 2).place != GONE -> heard[w] = 2
#endif
  fi;
  printf("hears %d %d %d\n", i + 1, w + 1, heard[w])
}

#define Decides(i) (up[i] && place[i] > FAR && place[i] <= LAST)

inline HearAndDecide(i) {
  if
  :: Decides(i) ->
     for (w : 0 .. N - 1) {
       if
       :: HearsAsPeer(i, w) -> Hear(i)
       :: else
       fi
     }
     w = 0;
     Decide(i)
  :: else
  fi
}

inline Forget(i) {
  for (j : 0 .. N - 1) {
    meets[AT(i, j)] = false;
    holds[AT(i, j)] = false;
    released[AT(i, j)] = false;
      stood[AT(i, j)] = false
  }
  waited[i] = 0;
  let_pass[i] = false;
  j = 0
}

/* A vehicle that is past, or out of reach, is no conflict for any other. */
inline Say(i) {
#if AGE >= 2
  Said(i, 2).place = Said(i, 1).place;
  Said(i, 2).gives_way_to = Said(i, 1).gives_way_to;
  Said(i, 2).waited = Said(i, 1).waited;
#endif
  if
  :: up[i] ->
     Said(i, 1).place = (place[i] == PAST -> FAR : place[i]);
     Said(i, 1).gives_way_to = gives_way[i];
     Said(i, 1).waited = order[i];
     if
     :: !InZone(place[i]) && Rises(i) ->
        unfrozen = under_way[i] && !(let_pass[i] && place[i] == GATE) && order[i] != AgedTicks(i);
        assert(!unfrozen);
        order[i] = AgedTicks(i)
     :: else
     fi
  :: else ->
     Said(i, 1).place = GONE;
     Said(i, 1).gives_way_to = NOBODY;
     Said(i, 1).waited = 0
  fi;
  if
  :: rests[i] -> waited[i] = 0; let_pass[i] = false
  :: else
  fi;
  gives_way[i] = NOBODY;
  under_way[i] = false;
  rests[i] = false
}

/* Crashes come between decision and motion: the last command still acts. Then the body rolls at most
 * as far as a braking vehicle may: the watchdog's ticks are part of the reaction time that every
 * stopping distance allows for. */
inline Crash() {
  if
  :: true
  :: crashes > 0 && up[v] && place[v] != FAR && place[v] != PAST ->
     d_step {
       printf("crash %d\n", v + 1);
       crashes--;
       up[v] = false;
       KeepGrant(v);
       Forget(v);
       order[v] = 0
     }
  :: restarts > 0 && !up[v] && place[v] != GONE && !Rolls(place[v]) ->
     d_step {
       printf("restart %d\n", v + 1);
       restarts--;
       up[v] = true
     }
  fi
}

inline MoveDead() {
  if
  :: !Rolls(place[v])
  :: Rolls(place[v]) && (go[v] || place[v] < LAST) -> place[v]++
  :: Rolls(place[v]) -> place[v] = GATE
  :: InZone(place[v]) -> place[v] = PAST
#ifndef WEATHER
  :: !Rolls(place[v]) -> place[v] = GONE
#endif
  fi
}

inline MoveAlive() {
  if
  :: place[v] == FAR
  :: place[v] == FAR -> place[v] = COMING
  :: place[v] == COMING -> place[v] = NEARER
  :: place[v] == NEARER -> place[v] = GATE + 1
  :: IsNear(place[v]) && !go[v] -> place[v] = GATE
  :: IsNear(place[v]) && go[v] ->
     d_step {
       place[v]++;
       if
       :: place[v] == ZONE -> Forget(v)
       :: else
       fi
     }
#ifdef STALL
  :: Rolls(place[v]) && go[v]
#endif
#ifndef ONE_STEP
  :: place[v] == ZONE -> place[v] = ZONE_END
#endif
  :: InZone(place[v]) -> place[v] = PAST
  :: place[v] == PAST
#ifndef ONCE
  :: place[v] == PAST -> place[v] = FAR
#endif
  fi
}

#if N == 2
#define InZoneNow (InZone(place[0]) + InZone(place[1]))
#else
#define InZoneNow (InZone(place[0]) + InZone(place[1]) + InZone(place[2]))
#endif

inline SayAndMove() {
  for (v : 0 .. N - 1) {
    Crash();
    d_step { Say(v) }
  }
  for (v : 0 .. N - 1) {
    if
    :: up[v] -> MoveAlive()
    :: else -> MoveDead()
    fi;
    go[v] = false;
    printf("place %d %d\n", v + 1, place[v])
  }
  v = 0;
  printf("tick\n");
  two_in_zone = InZoneNow > 1;
  assert(!two_in_zone)
}

active proctype Fleet() {
  atomic {
    for (v : 0 .. N - 1) {
      up[v] = true;
      if
      :: true
#ifndef EVEN
      :: fast[v] = true
#endif
      fi;
      printf("fast %d %d\n", v + 1, fast[v])
    }
    v = 0;
  }
  do
  :: atomic { HearAndDecide(0) }
#if N == 3
     atomic { HearAndDecide(1) }
#endif
     atomic {
       HearAndDecide(N - 1);
       SayAndMove()
     }
  od
}

#ifdef WEATHER
/* Losses end eventually: by weak fairness, not by a given time. */
active proctype Weather() { good = true }

/* A dead body that no longer rolls is eventually removed, unless it comes back before. */
active proctype Undertaker() {
  do
  :: atomic { !up[0] && !Rolls(place[0]) && place[0] != GONE -> place[0] = GONE }
  :: atomic { !up[1] && !Rolls(place[1]) && place[1] != GONE -> place[1] = GONE }
#if N == 3
  :: atomic { !up[2] && !Rolls(place[2]) && place[2] != GONE -> place[2] = GONE }
#endif
  od
}

#ifndef WHO
#define WHO 0
#endif
/* A living vehicle that has come near gets through. */
ltl passes { [] ((up[WHO] && IsNear(place[WHO])) -> <> (!up[WHO] || place[WHO] > LAST)) }
#endif
