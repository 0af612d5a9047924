#!/usr/bin/env bash
# Draws the plates of this folder anew. Needs ImageMagick (`convert`) beside what the program needs.
set -euo pipefail
cd "$(dirname "$0")"
restyle=../../target/release/restyle
(cd ../.. && cargo build --release --quiet)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# One sphere, and two joined by a connector.
printf '1\none atom\nC 0 0 0\n' > "$work/sphere.xyz"
printf '2\ntwo atoms\nC -0.7 0 0\nC 0.7 0 0\n' > "$work/pair.xyz"

# Fig. 3 of Prost 2016: alpha 0.5, beta 0.5, gamma 2, and 2, 4 and 8 steps.
toon() { # NAME PROPERTIES SCENE SIZE GEOMETRY
  cat > "$work/$1.json" <<JSON
{ "camera": { "bgcolor": "white", "fov": 25, "zoom": ${6:-1} }, "geometry": $5,
  "mapping": { "*": "s" },
  "shaders": [ { "name": "s", "shader": "toon", "properties": { $2 } } ],
  "lights": [ { "type": "directional", "position": [-1, 1, 1.2] } ] }
JSON
  "$restyle" render "$work/$3.xyz" -s "$work/$1.json" -o "$work/$1.png" --size "$4"
}
ball='{ "atom": "vdw", "scale": 1 }'
pair='{ "atom": "vdw", "scale": 0.32, "bond_radius": "0.22A" }'
for steps in 2 4 8; do
  toon "steps$steps" "\"base_color\": \"#4aa3df\", \"scale\": 0.5, \"bias\": 0.5, \"exponent\": 2, \"steps\": $steps, \"levels\": \"full\"" sphere 320x320 "$ball"
done
convert "$work"/steps{2,4,8}.png +append -strip -colors 255 png8:fig3_steps.png

# Fig. 4: outlines by dot product (upper row) and by hull (lower row), growing.
for bias in 0.25 0.4 0.5; do
  toon "dot$bias" "\"base_color\": \"#f2c230\", \"steps\": 3, \"levels\": \"centre\", \"outline_bias\": $bias" pair 420x240 "$pair" 1.9
done
for size in 4 12 24; do
  toon "hull$size" "\"base_color\": \"#f2c230\", \"steps\": 3, \"levels\": \"centre\", \"hull_size\": \"${size}pt\"" pair 420x240 "$pair" 1.9
done
convert \( "$work"/dot{0.25,0.4,0.5}.png +append \) \( "$work"/hull{4,12,24}.png +append \) -append -strip -colors 255 png8:fig4_outlines.png

# Table 1: the four looks of the paper on its four molecules.
published='advertisement education scientific future'
"$restyle" gallery c60 arsenic_trioxide anthracene magnesium $(printf -- '-s %s ' $published) -o "$work/table1" --size 300x300 >/dev/null 2>&1
for molecule in c60 arsenic_trioxide anthracene magnesium; do
  convert "$work/table1/$molecule".{advertisement,education,scientific,future}.png +append "$work/row_$molecule.png"
done
convert "$work"/row_{c60,arsenic_trioxide,anthracene,magnesium}.png -append -strip -colors 255 png8:table1.png

# All looks on four shipped scenes.
"$restyle" gallery gearbox c60 alpha_helix caffeine -o "$work/gallery" --size 160x160 >/dev/null 2>&1
for scene in gearbox c60 alpha_helix caffeine; do
  convert "$work/gallery/$scene".{advertisement,education,scientific,future,illustrative,technical,glass,xray,ghost}.png +append "$work/row_$scene.png"
done
convert "$work"/row_{gearbox,c60,alpha_helix,caffeine}.png -append -strip +dither -colors 255 png8:gallery.png

# The assembly in three looks, large.
for look in technical education advertisement; do
  "$restyle" render gearbox -s "$look" -o "$work/gearbox_$look.png" --size 760x620 2>/dev/null
done
convert "$work"/gearbox_{technical,education,advertisement}.png +append -strip +dither -colors 255 png8:gearbox.png
# Fig. 5: without ambient occlusion, with it, and with rays instead (upper row: a molecule, lower row: the assembly).
for effects in '' '"ao"'; do
  cat > "$work/ao$effects.json" <<JSON
{ "extends": "advertisement", "geometry": { "scale": 0.6 }, "mapping": { "post_effects": [$effects] },
  "shaders": [ { "name": "ao", "shader": "ssaoPost", "properties": { "radius": "4r" } } ] }
JSON
done
for scene in alpha_helix gearbox; do
  "$restyle" render "$scene" -s "$work/ao.json" -o "$work/${scene}_without.png" --size 380x340 2>/dev/null
  "$restyle" render "$scene" -s "$work/ao\"ao\".json" -o "$work/${scene}_with.png" --size 380x340 2>/dev/null
  "$restyle" render "$scene" -s "$work/ao\"ao\".json" -o "$work/${scene}_rays.png" --size 380x340 --renderer reference 2>/dev/null
done
convert \( "$work"/alpha_helix_{without,with,rays}.png +append \) \( "$work"/gearbox_{without,with,rays}.png +append \) -append \
  -strip +dither -colors 255 png8:fig5_occlusion.png

# Fig. 6: the five layers, by circles, in five layers, and through a whole lens.
for kind in '"show": "layers"' '"method": "gather"' '"method": "five_layer"'; do
  name=$(printf '%s' "$kind" | tr -dc 'a-z_')
  cat > "$work/$name.json" <<JSON
{ "extends": "advertisement", "mapping": { "post_effects": ["focus"] },
  "shaders": [ { "name": "focus", "shader": "dofPost", "properties": { "layers": [0, 0.15, 0.35, 0.7], "blur": "40pt", $kind } } ] }
JSON
  for scene in c60 gearbox; do
    "$restyle" render "$scene" -s "$work/$name.json" -o "$work/${scene}_$name.png" --size 300x280 2>/dev/null
  done
done
for scene in c60 gearbox; do
  "$restyle" render "$scene" -s "$work/methodgather.json" -o "$work/${scene}_lens.png" --size 300x280 --renderer reference 2>/dev/null
done
convert \( "$work"/c60_{showlayers,methodgather,methodfive_layer,lens}.png +append \) \
  \( "$work"/gearbox_{showlayers,methodgather,methodfive_layer,lens}.png +append \) -append -strip +dither -colors 255 png8:fig6_layers.png

# All ways to switch shadows, lines, occlusion and depth of field on and off.
for scene in caffeine bracket; do
  for after in '' '"ao"' '"focus"' '"ao", "focus"'; do
    row=()
    for before in '' '"lines"'; do
      for shadow in none soft; do
        listed=$(printf '%s\n' "$after" "$before" | tr ',' '\n' | tr -d ' ' | sed '/^$/d' | sort | paste -sd, | sed 's/"focus","lines"/"lines","focus"/')
        cat > "$work/one.json" <<JSON
{ "camera": { "bgcolor": "#dfe4ea" }, "geometry": { "atom": "vdw", "scale": 0.4, "bond_radius": "0.2A" },
  "mapping": { "*": "matt", "post_effects": [$listed] },
  "shaders": [ { "name": "matt", "shader": "basic", "properties": { "smoothness": 0.2, "metallic": 0 } },
    { "name": "ao", "shader": "ssaoPost" },
    { "name": "lines", "shader": "outlinePost", "properties": { "silhouette_width": "6pt", "crease_width": 0 } },
    { "name": "focus", "shader": "dofPost", "properties": { "layers": [0, 0.2, 0.4, 0.8], "blur": "30pt" } } ],
  "lights": [ { "type": "directional", "position": [-1, 2, 1.5], "intensity": 2, "shadow": "$shadow", "strength": 0.7, "softness": 8 },
    { "type": "ambient", "intensity": 0.5 } ] }
JSON
        picture="$work/${scene}_${#after}_${#before}_$shadow.png"
        "$restyle" render "$scene" -s "$work/one.json" -o "$picture" --size 180x180 2>/dev/null
        row+=("$picture")
      done
    done
    convert "${row[@]}" +append "$work/${scene}_row_${#after}.png"
  done
  convert "$work/${scene}"_row_{0,4,7,13}.png -append "$work/${scene}_together.png"
done
convert "$work"/{caffeine,bracket}_together.png +append -strip +dither -colors 255 png8:together.png

# Glass: a housing that is seen through, atoms of glass with lines, and a protein all of glass.
cat > "$work/housing.json" <<'JSON'
{ "extends": "scientific", "camera": { "bgcolor": "#f2f2ee" },
  "shaders": [{ "name": "shell", "shader": "basic", "properties": { "base_color": "material", "opacity": 0.3 } }],
  "mapping": { "mesh[part=*ousing*]": "shell" } }
JSON
cat > "$work/atoms.json" <<'JSON'
{ "extends": "scientific", "camera": { "bgcolor": "#f2f2ee" }, "geometry": { "atom": "vdw", "scale": 0.45 },
  "shaders": [{ "name": "glass", "shader": "basic", "properties": { "opacity": 0.3 } },
    { "name": "lines", "shader": "outlinePost", "properties": { "silhouette_width": "3pt" } }],
  "mapping": { "atom": "glass", "post_effects": ["lines"] } }
JSON
"$restyle" render gearbox -s "$work/housing.json" -o "$work/glass_1.png" --size 560x420 2>/dev/null
"$restyle" render caffeine -s "$work/atoms.json" -o "$work/glass_2.png" --size 420x420 2>/dev/null
convert "$work"/glass_{1,2}.png +append -strip +dither -colors 255 png8:glass.png

# Fig. 1 and 9 of Murray 2016: constant opacity, curvature on what is opaque, and opacity by curvature; Fig. 8: three transfer functions;
# and the three looks of glass.
curved() { # NAME PROPERTIES
  cat > "$work/$1.json" <<JSON
{ "camera": { "bgcolor": "#f4f6f8", "zoom": 1.25, "target": [0.05, -0.1, 0] }, "mapping": { "*": "g" },
  "shaders": [ { "name": "g", "shader": "curvature", "properties": { "base_color": "material", "smoothness": 0.8, $2 } } ],
  "lights": [ { "type": "directional", "position": [-1, 2, 2] }, { "type": "ambient", "intensity": 0.6 } ] }
JSON
  "$restyle" render gearbox -s "$work/$1.json" -o "$work/$1.png" --size 350x250 2>/dev/null
}
curved alone '"opacity": 0.6, "opacity_transfer": "constant", "color_transfer": "none", "contour_width": 0'
curved opaque '"opacity_transfer": "constant"'
curved fig7a '"opacity_transfer": "fig7a"'
curved fig7b '"opacity_transfer": "fig7b"'
curved fig8d '"opacity_transfer": "fig8d"'
curved fig6b '"opacity_transfer": "fig7b", "color_transfer": "fig6b"'
for pair in glass:gearbox xray:gearbox ghost:caffeine; do
  look=${pair%%:*} scene=${pair##*:}
  "$restyle" render "$scene" -s "$look" -o "$work/look_$look.png" --size 350x280 2>/dev/null
done
convert \( "$work"/{alone,opaque,fig7a}.png +append \) \( "$work"/{fig7b,fig8d,fig6b}.png +append \) \
  \( "$work"/look_{glass,xray,ghost}.png +append \) -append -strip +dither -colors 200 png8:curvature.png

# Glass in focus throughout, and through a lens.
cat > "$work/focus.json" <<'JSON'
{ "extends": "glass", "camera": { "zoom": 1.2, "target": [0.05, -0.1, 0] }, "mapping": { "post_effects": ["focus"] },
  "shaders": [ { "name": "focus", "shader": "dofPost", "properties": { "layers": [0.1, 0.3, 0.6, 0.9] } } ] }
JSON
sed 's/, "mapping": [^]]*\] }//' "$work/focus.json" > "$work/sharp.json"
"$restyle" render gearbox -s "$work/sharp.json" -o "$work/focus_1.png" --size 480x360 2>/dev/null
"$restyle" render gearbox -s "$work/focus.json" -o "$work/focus_2.png" --size 480x360 2>/dev/null
convert "$work"/focus_{1,2}.png +append -strip +dither -colors 255 png8:glass_focus.png

# Glass beside what is opaque: with lines, with ambient occlusion, without a background (here over white and over black), each drawn by the
# adapter and by the reference renderer.
glass_beside() { # NAME SCENE CAMERA GLASS SHADER PROPERTIES EFFECTS
  cat > "$work/$1.json" <<JSON
{ "camera": { "bgcolor": "#dfe4ea", $3 }, "geometry": { "atom": "vdw", "scale": 0.5, "bond_radius": "0.2A" },
  "mapping": { "*": "solid", "$4": "glass", "post_effects": [$7] },
  "shaders": [ { "name": "solid", "shader": "basic", "properties": { "smoothness": 0.2, "metallic": 0 } },
    { "name": "glass", "shader": "$5", "properties": { "smoothness": 0.5, $6 } },
    { "name": "ao", "shader": "ssaoPost" },
    { "name": "lines", "shader": "outlinePost", "properties": { "silhouette_width": "8pt", "crease_width": 0 } } ],
  "lights": [ { "type": "directional", "position": [-1, 2, 2] }, { "type": "ambient", "intensity": 0.6 } ] }
JSON
}
curved='"opacity_transfer": "glass", "color_transfer": "fig6a", "contour_width": "2pt"'
for scene in gearbox caffeine; do
  case $scene in
    gearbox) camera='"zoom": 2, "target": [-0.1, -0.1, 0]' glass='mesh[part=*ousing*]' ;;
    caffeine) camera='"zoom": 1' glass='atom[element=C]' ;;
  esac
  glass_beside lined "$scene" "$camera" "$glass" curvature "$curved" '"lines"'
  glass_beside dim "$scene" "$camera" "$glass" basic '"opacity": 0.35' '"ao"'
  glass_beside clear "$scene" "$camera" "$glass" curvature "$curved" '"ao", "lines"'
  for renderer in gpu reference; do
    for kind in lined dim clear; do
      picture="$work/beside_${kind}_$renderer.png"
      without=()
      [ $kind = clear ] && without=(--transparent)
      "$restyle" render "$scene" -s "$work/$kind.json" -o "$picture" --size 150x150 --renderer $renderer "${without[@]}" 2>/dev/null
    done
    for ground in white black; do
      convert "$work/beside_clear_$renderer.png" -background $ground -flatten "$work/beside_${ground}_$renderer.png"
    done
    convert "$work"/beside_{lined,dim,white,black}_$renderer.png +append "$work/beside_${scene}_$renderer.png"
  done
done
convert "$work"/beside_{gearbox,caffeine}_{gpu,reference}.png -append -strip +dither -colors 255 png8:glass_together.png

# Scenes that are hard for methods of transparency, as `measure failures` draws them: the reference, the lists, the k-buffer.
"$restyle" measure failures -o "$work/measured" >/dev/null 2>&1
scene=0
while IFS= read -r found; do
  case $found in
    '<h3>'*)
      scene=$((scene + 1)) picture=0
      convert -background white -fill black -font DejaVu-Sans -pointsize 13 -size 490x20 -gravity west \
        label:" ${found#<h3>}: reference, packed, bkb" +set label "$work/hard_$scene.png" ;;
    base64,*) bytes=${found#base64,} ;;
    alt=\"difference*) ;;
    *)
      picture=$((picture + 1))
      printf '%s' "$bytes" | base64 -d > "$work/hard_${scene}_$picture.png" ;;
  esac
done < <(grep -oE '<h3>[^<]*|base64,[^"]*|alt="[^"]*' "$work/measured/failures/index.html")
for number in $(seq "$scene"); do
  convert "$work/hard_${number}_"?.png -bordercolor white -border 2 +append "$work/hard_row.png"
  convert "$work/hard_$number.png" "$work/hard_row.png" -append -gravity west -background white -extent 500x144 \
    "$work/hard_$(printf '%02d' "$number")_all.png"
done
montage "$work"/hard_??_all.png -tile 2x -geometry +0+0 -background white miff:- |
  convert - -trim +repage -bordercolor white -border 4 -strip +dither -colors 250 png8:failures.png
ls -l -- *.png
