-- For cornell.lua: its light operators on other threads of this process than those who ask them. Each entry has places
-- of its own: two threads answer for `bounce`, one for `direct`, and one renders.
place "here" { bounce = 2 }
place "here" { direct = 1 }
place "here" { lighting = 1, image = 1, places = 1 }
