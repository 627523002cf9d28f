"""Members, expressions and multiplicities to insert into texts of SysML v2 and KerML.

``$a``, ``$b`` and ``$c`` are replaced by names of the text, whatever they name.
"""

MEMBERS = tuple(
    line.strip()
    for line in """
    part $a : $b;
    part def $a :> $b, $c;
    part $a : $b[0..*] ordered nonunique;
    part $a[1..$b.$c];
    part :>> $a = $b;
    ref $a :>> $b.$c;
    port $a : ~$b;
    port def $a :> $b { in $c; out item $a : $b; inout attribute x : $c; }
    connect $a to $b;
    connect ($a, $b, $c);
    connection $a : $b connect $b.$c to $a;
    connection def $a { end $b; end part $c : $a[1]; }
    interface $a : $b connect $b.$a to $c.$b;
    interface def $a { end $b; end port $c : ~$a; }
    bind $a = $b.$c;
    flow of $a from $b.$c to $a.$b;
    flow $a.$b to $c.$a;
    succession flow $a from $b to $c;
    flow def $a { end $b; end $c; }
    message $a of $b from $c to $a;
    event $a.$b;
    event occurrence $a;
    occurrence $a : $b { snapshot $c; timeslice $a; }
    individual part def $a :> $b;
    individual $a : $b;
    first $a then $b;
    first start then $a;
    succession first $a if $c then $b;
    then $a;
    then done;
    then action $a : $b { in $c = $a; out $b; }
    then perform $a.$b;
    then decide;
    if $a then $b;
    if $a > 3 then done;
    else $a;
    decide $a;
    merge $a;
    fork $a;
    join $a;
    if $a > 3 { assign $b := $c; } else if $b { action $a; } else { perform $c; }
    while $a { perform $b; } until $c;
    loop { accept $a; } until $b;
    loop action $a { then $b; }
    for $a in $b { perform $c; }
    for $a : $b in 1..99999999 { assign $b := $a; }
    accept $a : $b via $c;
    accept after 5 [SI::s];
    accept when $a > $b;
    accept at $a;
    action $a accept $b via $c.$a;
    send $a via $b to $c;
    send new $a($b = $c, $a) to $a;
    assign $a.$b := $c + 1;
    assign $a := $a;
    perform $a.$b;
    perform action $a : $b { in $c = $a; out :>> $b; }
    action def $a :> $b { in $c; out x : $a; return $b; first start; then $b; then done; }
    action $a : $b { in $c = $a.$b; in item x : $a; out y = $c; }
    terminate $a;
    terminate;
    state $a : $b { entry $b; do $c; exit $a; }
    state def $a parallel { state $b; state $c { entry; then $a; } }
    transition first $a accept $b if $c do $a then $b;
    transition $a then $b;
    transition first $a accept $b : $c via $a.$b do send $c() to $a then done;
    transition $a first $b if $a == $c then $b;
    accept $a if $b do $c then $a;
    entry; then $a;
    entry assign $a := $b; then $c;
    do action { loop { perform $a; } }
    exhibit state $a : $b parallel { state $c; }
    exhibit $a.$b;
    requirement $a : $b { subject $c; assume constraint { $a > 1 } require constraint { $b < $c } }
    requirement <'1'> $a { subject $b : $c; require $a; doc /* G F $b */ }
    satisfy $a by $b;
    assert not satisfy requirement $a : $b by $c;
    verify $a;
    constraint $a { $b == $c }
    constraint def $a { in $b; $a == $b and ($c or not $b) }
    assert constraint $a : $b;
    assert not $a;
    assume $a;
    require constraint : $a { in :>> $b = $c; }
    calc $a { in $b; return $c = $a($b); }
    calc def $a { in x : $b; return : $c; $a(x) + 1 }
    attribute $a = $b + $a [SI::kg];
    attribute $a : ScalarValues::Real = 1/0;
    attribute $a : ISQ::DurationValue = 5 [SI::min];
    attribute $a = $a;
    attribute def $a :> $b;
    attribute $a default := $b;
    alias $a for $b;
    alias <x> $a for $b::$c;
    private import $a::*;
    public import $a::**;
    private import all $a::*::**;
    private import $a::*[@$b and $c > 1];
    private import $a;
    package $a { private import $b::*; public import $a::*; }
    library package $a;
    metadata def $a :> $b { :> annotatedElement : SysML::PartUsage; attribute $c : $b; }
    @$a { $b = $c; }
    @$a about $b, $c;
    #$a part $b : $c;
    #$a def $b;
    metadata m : $a about $b { :>> $c = "x"; }
    variation part def $a { variant part $b; variant $c; }
    variation attribute $a : $b { variant $c; }
    enum def $a { $b; enum $c = 3; }
    allocate $a to $b;
    allocation $a : $b allocate $c to $a;
    dependency from $a to $b, $c;
    dependency $a to $b;
    use case $a { subject $b; actor $c : $a; include $b; objective { require $c; } }
    include use case $a : $b;
    case $a { objective $b; }
    analysis $a : $b { subject = $c; return $a; }
    verification $a { subject $c; objective { verify $b; } }
    concern $a { stakeholder $b; frame $c; }
    view $a : $b { expose $c::**; render $a; filter @$b; }
    viewpoint $a { frame $b; }
    rendering $a : $b;
    actor $a : $b;
    subject $a : $b = $c;
    objective $a;
    item $a : $b { attribute $c = $a.$b; }
    doc /* $a */
    comment $a about $b /* x */
    rep $a language "ocl" /* x */
    language "SPIN" /* G ($a -> F $b) */
    require constraint { language "LTL" /* G ($a -> X $b) */ }
    snapshot $a;
    return $a : $b = $c;
    in $a : $b = $c;
    end $a [0..1] : $b crosses $c.$a;
    filter $a;
    part $a : $b { part $a : $b { part $a :>> $a : $b; } }
    @RecipeLevels::Task;
    action $a :> RecipeLevels::Task { action $b :> RecipeLevels::MachineService; then $c; }
    part $a :> RecipeLevels::Machine { perform $b; }
    """.strip().splitlines()
)
"""Members of SysML v2."""

KERML_MEMBERS = tuple(
    line.strip()
    for line in """
    class $a specializes $b, $c;
    struct $a :> $b { feature $c : $a; }
    datatype $a :> $b;
    classifier $a unions $b, $c;
    classifier $a intersects $b, $a;
    type $a differences $b, $c;
    type $a disjoint from $b;
    type $a conjugates $b;
    metaclass $a :> $b;
    assoc $a { end $b; end feature $c : $a; }
    assoc struct $a :> $b { end $b [1] : $c; }
    feature $a : $b subsets $c;
    feature $a : $b[1..*] ordered nonunique :>> $c = $a.$b;
    feature $a chains $b.$c.$a;
    feature $a inverse of $b;
    feature $a featured by $b, $c;
    feature $a crosses $b.$c;
    feature :>> $a;
    portion feature $a : $b;
    in $a : $b;
    connector $a : $b from $b.$c to $c;
    connector $a ($b, $c, $a);
    binding $a = $b.$c;
    binding $a of $b = $c;
    succession $a first $b then $c;
    flow $a of $b from $c.$a to $b.$c;
    interaction $a :> $b { end $c; end $a; }
    behavior $a :> $b { in $b; out $c; step $c : $a; succession $b then $c; }
    function $a { in x : $b; return : $c; $a(x) + $b }
    function $a :> $b { return $c = $a($b, $c); }
    predicate $a { in $b; $b > $c and $a($c) }
    expr $a : $b { $c }
    bool $a { $b istype $c }
    inv not $a { $b == $c }
    step $a : $b { in $c = $b; }
    multiplicity $a [2..$b];
    multiplicity $a :> $b;
    specialization $a subtype $b specializes $c;
    subclassifier $a specializes $b;
    subset $a subsets $b.$c;
    redefinition $a redefines $b;
    typing $a typed by $b;
    conjugation conjugate $a conjugates $b;
    disjoint $a from $b;
    inverse $a of $b.$c;
    featuring of $a by $b;
    namespace $a { private import $b::*; }
    package $a { public import $b::**; }
    alias $a for $b;
    comment about $a, $b /* x */
    @$a about $b;
    metadata $a about $b { $c = $a; }
    #$a class $b :> $c;
    dependency $a to $b, $c;
    member feature $a featured by $b;
    private import all $a::*;
    filter $a istype $b;
    """.strip().splitlines()
)
"""Members of KerML."""

EXPRESSIONS = (
    "$a",
    "$a.$b.$c",
    "$a::$b",
    "1",
    "-1",
    "*",
    "1/0",
    "0 % 0",
    "2 ** 99999",
    "2 ** -1 ** 0.5",
    "9" * 400,
    "1e400",
    "1.5e-400 [$a]",
    "5 [SI::s]",
    "5 [$b]",
    "5 [SI::m] + 3 [SI::kg]",
    "10000 [SI::ms] < 10 [SI::s]",
    "true and not ($a or false) xor $b implies $c",
    "null",
    '"text" + $a',
    '"' + "x" * 3000 + '"',
    "'no such name'",
    "$a($b, $c)",
    "$a(x = $b)",
    "$a::$a($a($a))",
    "new $a($b)",
    "all $a",
    "$a->collect {in x; x.$b}",
    "$a.{in x : $b; x > $c}",
    "$a.?{in x; x.$b == $c}",
    "$a->select {in x; x}->size()",
    "$a->reduce '+'",
    "sum($a.$b) / size($c)",
    "if $a ? $b else if $b ? $c else $a",
    "$a as $b",
    "$a istype $b and $b hastype $c",
    "$a @ $b or @$c",
    "$a meta $b",
    "$a.metadata",
    "($a, $b, ($c, 1..3))#(2)",
    "($a, $b)#(0)",
    "1..999999999",
    "$a[3]",
    "$a ?? $b",
    "$a === $b",
    "SequenceFunctions::size($a) > 1",
    "(" * 300 + "$a" + ")" * 300,
    "- " * 300 + "1",
    "not " * 300 + "$a",
    "$a" + " + $b" * 300,
    "$a" + ".$b" * 200,
    "{}",
    "{ $a }",
    "()",
    "(,)",
    "$a = $b",
    "self.$a",
    "that.$a.$b",
)
MULTIPLICITIES = (
    "[0]",
    "[*]",
    "[0..*]",
    "[1..0]",
    "[-1]",
    "[1.5]",
    "[$a]",
    "[$a.$b..$c]",
    "[99999999999999999999]",
    "[$a..$a] nonunique ordered",
    "[1][2]",
    "[]",
    "[3..2..1]",
    "[if $a ? 1 else 2]",
)
JUNK = (
    "\0",
    "\ufeff",
    "\u202e",
    "é€\U0001f600",
    "'",
    '"',
    "/*",
    "*/",
    "//*",
    "''",
    "'a\\'b'",
    '"\\u0041"',
    "'::'",
    "$::x",
    "$",
    "`",
    "\\",
    "...",
    ":::",
    "->",
    "#",
    "@",
    "<<<<<<< HEAD\n",
    "x" * 3000,
    "1.2.3",
    "0x1F",
    "1e",
    "\r",
    "\v",
)
