/* The points at which the model can be broken on purpose: as it should be, and each injected defect.
 * What SPIN must find stands in runs.txt. */

/* The priority by key, as it should be. */
#define PrecedesByKey(waited_a, a_, waited_b, b_) \
  ((waited_a) > (waited_b) ||                  \
   ((waited_a) == (waited_b) && (fast[a_] > fast[b_] || (fast[a_] == fast[b_] && (a_) < (b_)))))

#ifdef PRIORITY_REVERSED
#define HasPriority(waited_a, a_, waited_b, b_) (!PrecedesByKey(waited_a, a_, waited_b, b_))
#elif defined(TIE_NOT_BROKEN)
#define HasPriority(waited_a, a_, waited_b, b_) \
  (PrecedesByKey(waited_a, a_, waited_b, b_) ||  \
   ((waited_a) == (waited_b) && fast[a_] == fast[b_]))
#else
#define HasPriority(waited_a, a_, waited_b, b_) PrecedesByKey(waited_a, a_, waited_b, b_)
#endif

#ifdef LATCH_DROPPED
#define Latched(held) false
#else
#define Latched(held) (held)
#endif

#ifdef SECOND_DRIVES_ON
#define SecondMustStop(must) false
#else
#define SecondMustStop(must) (must)
#endif

#ifdef GRANT_NOT_AWAITED
#define Grants(said_so) true
#else
#define Grants(said_so) (said_so)
#endif

#ifdef ORDER_NOT_FROZEN
#define Rises(i) true
#else
#define Rises(i) (!under_way[i] || (let_pass[i] && place[i] == GATE))
#endif

#ifdef WAITING_FORGOTTEN
#define ForgetsWaiting(rests_) (rests_)
#else
#define ForgetsWaiting(rests_) false
#endif

#ifdef THROUGH_FIRST_GUESSED
#define IsThroughFirst(own, peer, age) true
#elif defined(IN_FIRST_GUESSED)
#define IsThroughFirst(own, peer, age) (StepsToZone(own) <= StepsToZone(peer))
#elif defined(ONE_LANE)
/* In before the peer, hearing of it, is where it can stop outside for the last time. */
#define IsThroughFirst(own, peer, age) (StepsToZone(own) < StepsToZone(peer) - 1 - (age))
#else
#define IsThroughFirst(own, peer, age) (StepsThrough(own) < StepsToZone(peer) - (age))
#endif

#ifdef OVER_TOO_EARLY
#define IsConflict(p_) ((p_) != FAR && !InZone(p_))
#else
#define IsConflict(p_) ((p_) != FAR)
#endif

#ifdef SILENCE_IS_CONSENT
#define HoldsForLost(must) false
#else
#define HoldsForLost(must) (must)
#endif

#ifdef RELEASED_WITHOUT_LOOKING
#define MayRelease(nothing_near) true
#else
#define MayRelease(nothing_near) (nothing_near)
#endif

#ifdef AGE_IGNORED
#define TrustedAge(age) 1
#else
#define TrustedAge(age) (age)
#endif

#ifdef OWN_BEACON_HEARD
#define HearsAsPeer(i, j_) true
#else
#define HearsAsPeer(i, j_) ((i) != (j_))
#endif

#ifdef AGE_LIMIT_IGNORED
#define IsExplained(i, j_) (IsFresh(heard[j_]) || meets[AT(i, j_)])
#elif defined(ULTRASONICS_IGNORED)
#define IsExplained(i, j_) true
#elif defined(OLD_GRANT_KEPT)
#define IsExplained(i, j_) (IsFresh(heard[j_]) || old_grant[i])
#else
#define IsExplained(i, j_) IsFresh(heard[j_])
#endif

#ifdef OLD_GRANT_KEPT
bool old_grant[N];
#define KeepGrant(i) old_grant[i] = true
#else
#define KeepGrant(i) skip
#endif

#ifdef NO_CLAIMS
#define Claimed(p_, a_) false
#else
#ifdef CLAIM_WITHOUT_STOPPING_WAY
#define Claimed(p_, a_) InZone(p_)
#else
/* Where a peer that was at p_ when its beacon of that age was said can be by the end of this tick. */
#define Claimed(p_, a_)                                          \
  (InZone(p_) || (Rolls(p_) && (p_) - GATE + (a_) >= RUNUP) || \
   ((p_) != FAR && (p_) <= GATE && (a_) >= RUNUP))
#endif
#endif

#ifdef NO_AGREEMENT
#define IGNORES_AGREEMENT true
#else
#define IGNORES_AGREEMENT false
#endif

#if defined(NO_AGREEMENT) || defined(ONLY_EXCLUSION)
#define CHECKS_AGREEMENT false
#else
#define CHECKS_AGREEMENT true
#endif
