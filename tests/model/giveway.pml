/* first draft */
#ifndef N
#define N 2
#endif
#ifndef AGE
#define AGE 2
#endif
#ifndef RUNUP
#define RUNUP (AGE + 1)
#endif
#ifndef WAITED_MOST
#define WAITED_MOST 2
#endif
#ifndef WAITED_LIMIT
#define WAITED_LIMIT 1
#endif
#ifndef CRASHES
#define CRASHES 0
#endif
#ifndef RESTARTS
#define RESTARTS 0
#endif

#define STALE (AGE + 2)
#define UNKNOWN 0

#define FAR 0
#define COMING 1
#define NEARER 2
#define GATE 3
#define FIRST_ROLL (GATE + 1)
#define LAST (GATE + RUNUP)
#define ZONE (LAST + 1)
#define ZONE_END (LAST + 2)
#define PAST (LAST + 3)
#define GONE (LAST + 4)

#define NOBODY 0

#define SILENT 0
#define BEFORE 1
#define NOW 2

typedef Said {
  byte place;
  byte gives_way_to;
  byte waited;
  byte life;
};

Said said[N * AGE];       /* [sender * AGE + age - 1] */
byte place[N];
bool up[N];
bool go[N];
bool fast[N];
byte age[N * N];          /* [hearer * N + sender] */
bool accepted[N * N];
bool meets[N * N];
bool holds[N * N];
bool lost[N * N];
bool released[N * N];
bool was_free[N * N];
byte waited[N];
byte order[N];
bool had_encounters[N];
byte crashes = CRASHES, restarts = RESTARTS;
bool good = false;

#define AT(i, j) ((i) * N + (j))
#define OF(j, a) said[(j) * AGE + (a) - 1]
#define IsNear(p) ((p) >= GATE && (p) <= LAST)
#define InZone(p) ((p) == ZONE || (p) == ZONE_END)
#define IsBody(p) ((p) >= GATE && (p) <= ZONE_END)
#define Fresh(i, j) (age[AT(i, j)] >= 1 && age[AT(i, j)] <= AGE)

/* order */
#define KeyFirst(wa, fa, a, wb, fb, b) \
  ((wa) > (wb) || ((wa) == (wb) && ((fa) > (fb) || ((fa) == (fb) && (a) < (b)))))

/* steps from a said place into the zone, at the fastest */
#define StepsToZone(p) ((p) <= NEARER -> NEARER - (p) + RUNUP + 1 : ZONE - (p))
#define StepsThrough(p) (PAST - (p))

#define Claimed(p, a) (InZone(p) || (p) == PAST + 100 || ((p) > GATE && (p) <= LAST && (p) - GATE + (a) >= RUNUP) || ((a) >= RUNUP && (p) <= GATE))

hidden byte i, j;
hidden byte conflict, goes_first, standing, grants, through, clear, deaf, encounters, waits;
hidden byte p, way;
byte v, w;

inline Look() {
  p = OF(j, age[AT(i, j)]).place;
  standing = p == GATE;
  goes_first = KeyFirst(OF(j, age[AT(i, j)]).waited, fast[j], j, order[i], fast[i], i);
  conflict = p != PAST && place[i] != PAST && !(standing && !goes_first);
  grants = OF(j, age[AT(i, j)]).gives_way_to == i + 1 || (standing && !goes_first);
  through = !conflict || (place[i] <= LAST && place[i] >= GATE && StepsThrough(place[i]) < StepsToZone(p) - age[AT(i, j)]) || (InZone(place[i]));
}

inline Update() {
  if
  :: age[AT(i, j)] == UNKNOWN ->
     meets[AT(i, j)] = false; holds[AT(i, j)] = false; lost[AT(i, j)] = false; released[AT(i, j)] = false; was_free[AT(i, j)] = false
  :: age[AT(i, j)] > AGE ->
     if
     :: meets[AT(i, j)] ->
        released[AT(i, j)] = released[AT(i, j)] || (lost[AT(i, j)] && clear);
        lost[AT(i, j)] = true;
        holds[AT(i, j)] = !released[AT(i, j)] && (holds[AT(i, j)] || (place[i] == LAST && !was_free[AT(i, j)]))
     :: else
     fi
  :: else ->
     Look();
     lost[AT(i, j)] = false; released[AT(i, j)] = false;
     if
     :: !meets[AT(i, j)] -> meets[AT(i, j)] = conflict && !through
     :: else -> meets[AT(i, j)] = conflict || (p == GATE && place[i] != PAST)
     fi;
     was_free[AT(i, j)] = meets[AT(i, j)] && !conflict;
     holds[AT(i, j)] = meets[AT(i, j)] && IsNear(place[i]) &&
        (goes_first -> holds[AT(i, j)] || (conflict && (IsBody(p) || place[i] == LAST))
                     : !(grants || through) && (holds[AT(i, j)] || place[i] == LAST));
     if
     :: meets[AT(i, j)] && goes_first && place[i] <= LAST && (way == NOBODY || p >= OF(way - 1, age[AT(i, way - 1)]).place) -> way = j + 1
     :: else
     fi;
     if
     :: place[i] == LAST && Claimed(p, age[AT(i, j)]) -> go[i] = false
     :: else
     fi
  fi;
  if
  :: holds[AT(i, j)] -> go[i] = false; waits = true
  :: else
  fi;
  encounters = encounters || meets[AT(i, j)]
}

inline Decide() {
  go[i] = true; way = NOBODY; encounters = false; waits = false;
  clear = true; deaf = false;
  for (j : 0 .. N - 1) {
    if
    :: j != i && IsBody(place[j]) ->
       clear = false;
       deaf = deaf || (!Fresh(i, j) && place[j] > GATE)
    :: else
    fi
  }
  for (j : 0 .. N - 1) {
    if
    :: j != i -> Update()
    :: else
    fi
  }
  if
  :: deaf && IsNear(place[i]) -> go[i] = false; waits = true
  :: else
  fi
}

inline Remember() {
  if
  :: waits && place[i] == GATE && waited[i] < WAITED_MOST -> waited[i]++
  :: else
  fi;
}

inline Say() {
  for (p : 1 .. AGE - 1) {
    OF(i, AGE + 1 - p).place = OF(i, AGE - p).place;
    OF(i, AGE + 1 - p).gives_way_to = OF(i, AGE - p).gives_way_to;
    OF(i, AGE + 1 - p).waited = OF(i, AGE - p).waited;
    OF(i, AGE + 1 - p).life = OF(i, AGE - p).life;
  }
  if
  :: up[i] && place[i] != GONE ->
    OF(i, 1).place = place[i]; OF(i, 1).gives_way_to = way; OF(i, 1).waited = order[i]; OF(i, 1).life = NOW
  :: else -> OF(i, 1).place = 0; OF(i, 1).gives_way_to = 0; OF(i, 1).waited = 0; OF(i, 1).life = SILENT
  fi
}

inline AllDecide() {
  d_step {
    for (i : 0 .. N - 1) {
      if
      :: up[i] && place[i] > FAR && place[i] != GONE ->
         Decide();
         Remember()
      :: else -> way = NOBODY; if :: up[i] -> go[i] = true; encounters=false; waits=false; waited[i] = 0 :: else fi
      fi;
      Say();
      if
      :: up[i] ->
        if
        :: !encounters || !had_encounters[i] -> order[i] = (waited[i] > WAITED_LIMIT -> waited[i] : 0)
        :: else
        fi;
        if :: !encounters && !waits -> waited[i] = 0 :: else fi;
        had_encounters[i] = encounters
      :: else
      fi
    }
    i = 0; j = 0; p = 0; way = 0; conflict = 0; goes_first = 0; standing = 0; grants = 0; through = 0; clear = 0; deaf = 0; encounters = 0; waits = 0;
  }
}

#define Grown(a) ((a) == UNKNOWN -> UNKNOWN : ((a) >= STALE -> STALE : (a) + 1))

inline Hear() {
  if
  :: place[v] == FAR || place[v] == GONE || !up[v] -> skip
  :: else ->
    age[AT(v, w)] = Grown(age[AT(v, w)]);
    if
    :: true
    :: OF(w, 1).life == NOW && age[AT(v, w)] != 1 -> age[AT(v, w)] = 1
    :: OF(w, 2).life == NOW && (age[AT(v, w)] > 2 || age[AT(v, w)] == UNKNOWN) -> age[AT(v, w)] = 2
    fi;
    if
    :: Fresh(v, w) && OF(w, age[AT(v, w)]).place == FAR -> age[AT(v, w)] = UNKNOWN
    :: else
    fi
  fi
}

inline AllHear() {
  for (v : 0 .. N - 1) {
    for (w : 0 .. N - 1) {
      if
      :: v != w -> Hear()
      :: else
      fi
    }
  }
  v = 0; w = 0
}

inline Move() {
  if
  :: place[v] == FAR
  :: place[v] == FAR -> place[v] = COMING
  :: place[v] == COMING -> place[v] = NEARER
  :: place[v] == NEARER -> place[v] = FIRST_ROLL
  :: IsNear(place[v]) && !go[v] -> place[v] = GATE
  :: IsNear(place[v]) && go[v] -> place[v]++
  :: IsNear(place[v]) && go[v] && place[v] > GATE
  :: place[v] == ZONE -> place[v] = ZONE_END
  :: place[v] == ZONE -> place[v] = PAST
  :: place[v] == ZONE_END -> place[v] = PAST
  :: place[v] == PAST
  :: place[v] == PAST -> place[v] = FAR; 
     for (w : 0 .. N - 1) { age[AT(v, w)] = UNKNOWN; meets[AT(v, w)] = false; holds[AT(v, w)] = false;
       lost[AT(v, w)] = false; released[AT(v, w)] = false; was_free[AT(v, w)] = false }
     w = 0
  fi
}

inline AllMove() {
  for (v : 0 .. N - 1) { Move() }
  v = 0;
}

active proctype Fleet() {
  atomic {
    for (v : 0 .. N - 1) {
      up[v] = true;
      go[v] = true;
      if
      :: fast[v] = true
      :: fast[v] = false
      fi
    }
    v = 0;
  }
  do
  :: atomic {
       AllHear();
       AllDecide();
       AllMove();
#if N == 2
       assert(!(InZone(place[0]) && InZone(place[1])));
#else
       assert(InZone(place[0]) + InZone(place[1]) + InZone(place[2]) <= 1);
#endif
     }
  od
}
